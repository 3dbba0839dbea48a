#!/bin/sh
# test_transcode.sh - ted4enc --transcode: a file goes from profile Main to Compact and comes back,
# with the same tiers on the way and at the end, and a second time byte for byte; a grid whose order
# is not that of profile Main is sorted, with a warning; chunks that may be untrue are dropped;
# errors are reported, and options of a training are refused. Prints lines as a cmocka program does;
# run by `make test` from the project's root.
# SPDX-License-Identifier: BSD-2-Clause
set -u
. tests/support/speak.sh
need transcode ted4enc ted4dec ted4info
enc=$TED4_BUILD/ted4enc
dec=$TED4_BUILD/ted4dec
vectors=conformance/vectors

# The tiers of a file that do not depend on the profile: all but T0.
tiers() { "$dec" --ted4-run "$1" --tiers T1,T2,T3,T4; }
there() { "$enc" --transcode "$1" --profile compact -q -f -o "$out/c.ted4"; }
back() { "$enc" --transcode "$out/c.ted4" --profile main -q -f -o "$out/m.ted4"; }

for f in "$vectors"/content/CNT-pop-0.002.ted4 "$vectors"/content/CNT-still-0.008.ted4 \
    "$vectors"/content/CNT-turn-0.008.ted4; do
    name=$(basename "$f" .ted4)
    there "$f" && tiers "$f" >"$out/before" && tiers "$out/c.ted4" >"$out/after" &&
        cmp -s "$out/before" "$out/after" && ok "same_$name" || fail "same_$name" "other tiers"
    # After the first round, deflated bytes are those of this machine's zlib and no longer change.
    back && tiers "$out/m.ted4" >"$out/after" && cmp -s "$out/before" "$out/after" &&
        ok "back_$name" || fail "back_$name" "other tiers"
    mv "$out/m.ted4" "$out/first.ted4"
    there "$out/first.ted4" && back && cmp -s "$out/first.ted4" "$out/m.ted4" &&
        ok "again_$name" || fail "again_$name" "other bytes"
done
there "$vectors/content/CNT-pop-0.002.ted4"
[ "$(wc -c <"$out/c.ted4")" -lt "$(wc -c <"$vectors/content/CNT-pop-0.002.ted4")" ] &&
    ok smaller || fail smaller "$(wc -c <"$out/c.ted4") bytes"
expect named 0 'Compact profile' "$TED4_BUILD/ted4info" "$out/c.ted4"
"$TED4_BUILD/ted4info" --validate "$out/c.ted4" >"$out/said" 2>&1
grep -q adv.minor "$out/said" && fail minor "$(cat "$out/said")" || ok minor

# R-EDT-003: deflated bytes whose mode stays are copied from the file, not deflated again.
for f in container/CON-pack-all header/HDR-bank_dim-1-bank header/HDR-bank_dim-1-concat; do
    f=$vectors/valid/$f.ted4
    name=$(basename "$f" .ted4)
    "$enc" --transcode "$f" --profile main -q -f -o "$out/m.ted4"
    tail -c +13 "$f" >"$out/before" && tail -c +13 "$out/m.ted4" >"$out/after"
    cmp -s "$out/before" "$out/after" && ok "copied_$name" || fail "copied_$name" "other bytes"
done

# Positions of a grid: the same Gaussians in another order.
grid=$vectors/valid/compact/CMP-order.ted4
expect sorted 0 'anchors are in another order' \
    "$enc" --transcode "$grid" --profile main -q -f -o "$out/m.ted4"
"$dec" --ted4-run "$grid" --tiers T1 >"$out/before"
"$dec" --ted4-run "$out/m.ted4" --tiers T1 >"$out/after"
cmp -s "$out/before" "$out/after" && fail reordered "the same order" || ok reordered
expect reordered_valid 0 '"valid"' "$dec" --ted4-run "$out/m.ted4" --tiers T1

ancillary=$vectors/valid/extension/EXT-many.ted4
expect dropped 0 'unknown chunks are left out' \
    "$enc" --transcode "$ancillary" --profile compact -q -f -o "$out/a.ted4"
expect dropped_one 0 'warning: 1 unknown chunk is left out' \
    "$enc" --transcode "$vectors/valid/extension/EXT-size-0.ted4" -f -o "$out/a.ted4"
expect missing 3 "ted4enc: $out/none: No such file or directory" \
    "$enc" --transcode "$out/none" -f -o "$out/a.ted4"
expect broken 1 'speak.sh: byte 0: not a TED4 file [con.magic]' \
    "$enc" --transcode tests/support/speak.sh -f -o "$out/a.ted4"
head -c 500 "$grid" >"$out/cut.ted4"
expect cut 1 "ted4enc: $out/cut.ted4: byte " "$enc" --transcode "$out/cut.ted4" -o "$out/no.ted4"
expect cut_json 1 '"verdict":"invalid","error":"con.truncated","offset":' \
    "$enc" --transcode "$out/cut.ted4" -o "$out/no.ted4" --json
[ -e "$out/no.ted4" ] && fail cut_writes_nothing "an output" || ok cut_writes_nothing
expect missing_json 3 '"verdict":"io"' "$enc" --transcode "$out/none" -o "$out/no.ted4" --json
expect scene_too 3 'no scene folder' "$enc" scene --transcode "$grid" -f -o "$out/a.ted4"
expect which_profile 3 'expected main or compact' "$enc" --profile small --transcode "$grid" \
    -f -o "$out/a.ted4"

# Options of training are refused beside it: none is silently ignored, and nothing is written.
cp "$grid" "$out/kept.ted4"
alone() {
    name=$1; shift
    expect "alone_$name" 3 "ted4enc: --$name does not go with --transcode" \
        "$enc" --transcode "$ancillary" -o "$out/kept.ted4" -f "$@"
}
alone check --check
alone title --title x
alone cameras --cameras
alone log --log "$out/log"
alone resume --resume --checkpoint "$out/point" --stage1 "$out/point"
alone preset --preset draft
alone lambda --lambda 0.01
alone set --set offsets=4
alone seed --seed 2
expect alone_without_output 3 'does not go with --transcode' \
    "$enc" --transcode "$ancillary" --check
cmp -s "$grid" "$out/kept.ted4" && [ ! -e "$out/log" ] && ok alone_writes_nothing ||
    fail alone_writes_nothing "a file"
expect goes_with 0 '"bytes":' "$enc" --transcode "$grid" --profile main -o "$out/a.ted4" -f -j 1 \
    -v --json
# The JSON object says about the new file what that of a training says about its file.
for profile in main compact; do
    "$enc" --transcode "$grid" --profile $profile -o "$out/a.ted4" -f -q --json >"$out/said" 2>&1
    "$TED4_BUILD/ted4info" "$out/a.ted4" --json >"$out/json"
    for f in bytes profile anchors gaussians moving hash; do
        named=$f; [ $f = moving ] && named=dynamic
        check "json_${profile}_$f" "$out/said" \
            "\"$named\":$(sed "s/.*\"$f\":\([^,}]*\).*/\1/" "$out/json")"
    done
done
exit $bad
