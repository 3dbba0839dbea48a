#!/bin/sh
# test_judge_told.sh - ted4enc says on the terminal and in its log how many steps the judge leaves
# out, and a shortened stage 1 can be kept and continued (--stage1). Prints lines as a cmocka
# program does; run by `make test` from the project's root.
# SPDX-License-Identifier: BSD-2-Clause
set -u
. tests/support/speak.sh
need judge_told ted4enc ted4scene
# equal NAME VALUE WANTED
equal() { if [ "$2" = "$3" ]; then ok "$1"; else fail "$1" "$2, expected $3"; fi; }

# Without learning, pictures stand still: 320 steps, then two turns of eight groups, each of 140
# steps and the rest of a round of 21 pictures, then nothing of stage 1.
still="--preset draft --iterations 3200,40 --seed 1 -j 1 --capacity fixed --set probe=0
    --set init_anchors=100 --set max_anchors=200 --set offsets=4 --set feature=8 --set phi=4
    --set bank_dim=8 --set deform_width=8 --set head_width=12 --set sprouts=0 --set grow_until=0
    --set activation=0 --set poses=0 --set motion_worth=0 --set dropout=0 --set judge=1"
for rate in feature scaling offset phi tau mask heads motion prior colour; do
    still="$still --set lr_$rate=0"
done

# encode NAME [OPTION...]
encode() {
    name=$1; shift
    "$TED4_BUILD/ted4enc" "$out/turn" -o "$out/$name.ted4" --log "$out/$name.jsonl" $still "$@" \
        -f 2>"$out/$name.err" || fail "$name" "$(cat "$out/$name.err")"
}
# What the log says: the steps that decisions have left out.
logged() {
    sed -n 's/.*"event":"judge".*"left_out":\([0-9]*\)}$/\1/p' "$out/$1.jsonl" | grep -v '^0$'
}
said() { sed -n 's/.*judge: .*; \([0-9]*\) steps of stage 1 are left out$/\1/p' "$out/$1.err"; }
last() { sed -n 's/^{"step":\([0-9]*\),"stage".*/\1/p' "$out/$1.jsonl" | tail -1; }

"$TED4_BUILD/ted4scene" turn -o "$out/turn" --size 48x32 --frames 4 --cameras 6 --test-cameras 1 \
    -j 1 2>/dev/null
encode whole --stage1 "$out/stage1"
left=$(logged whole)
if [ "$left" -gt 300 ] && [ "$left" -lt 600 ]; then ok left_out; else fail left_out "$left"; fi
equal windows "$(grep -c '"event":"judge"' "$out/whole.jsonl")" 16
equal said "$(said whole)" "$left"
equal steps "$(last whole)" $((3240 - left))
encode off --set judge=0
equal off "$(grep -c '"event":"judge"' "$out/off.jsonl")" 0
equal off_said "$(grep -c 'judge:' "$out/off.err")" 0
equal off_steps "$(last off)" 3240

# A run that begins at the kept end of stage 1 writes the same file.
encode again --stage1 "$out/stage1"
equal again_windows "$(grep -c '"event":"judge"' "$out/again.jsonl")" 0
cmp -s "$out/whole.ted4" "$out/again.ted4" && ok again_file || fail again_file "another file"

# The search for a size begins at the end of the shortened stage.
encode target --target-size 1000000 --stage1 "$out/target_stage1"
equal target "$(logged target)" "$left"
exit $bad
