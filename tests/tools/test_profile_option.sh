#!/bin/sh
# test_profile_option.sh - ted4enc --profile: compact is the default, and of several options for it,
# --set included, the last one counts, as with --iterations, --lambda and --capacity; a file of
# profile Compact says so, has its positions on the grid, and is the same if training was stopped
# and resumed; decoders of version 1.0 can read a file of profile Main. Prints lines as a cmocka
# program does; run by `make test` from the project's root.
# SPDX-License-Identifier: BSD-2-Clause
set -u
export LC_ALL=C
. tests/support/speak.sh
need profile_option ted4enc ted4dec ted4info ted4scene
small='--preset draft --seed 1 -j 1 -f --set stage1=60 --set max_anchors=300
    --set init_anchors=200 --set feature=8 --set deform_width=16 --set head_width=16
    --set hyper_width=16 --set ar_width=8 --set slices=2'
small=$(echo $small)
"$TED4_BUILD/ted4scene" pop -o "$out/pop" --size 32x24 --frames 4 --cameras 5 --test-cameras 1 \
    -j 1 2>/dev/null || fail scene "not made"

# train NAME OPTIONS...: $out/NAME.ted4
train() {
    name=$1; shift
    "$TED4_BUILD/ted4enc" "$out/pop" -o "$out/$name.ted4" $small "$@" >"$out/$name.said" 2>&1 ||
        fail "$name" "$(cat "$out/$name.said")"
}
same()  { if cmp -s "$out/$2.ted4" "$out/$3.ted4"; then ok "$1"; else fail "$1" "$2, $3"; fi; }

train plain   --iterations 60,40
train compact --profile compact --iterations 60,40
train back    --profile compact --iterations 60,40 --set profile=0
train main    --profile main --iterations 60,40
same  compact_is_default plain compact
same  set_wins main back
train again   --set profile=0 --set stage2=9 --profile compact --iterations 60,40
same  last_holds compact again
"$TED4_BUILD/ted4enc" "$out/pop" -o "$out/last.ted4" $small --set lambda=0.5 --set capacity=1 \
    --set stage2=9 --lambda 0.01 --capacity fixed --iterations 6,4 --json >"$out/last.json" \
    2>"$out/last.said" || fail last "$(cat "$out/last.said")"
check last_of_all "$out/last.json" '"lambda":0.01,' '"steps":10,'
cmp -s "$out/main.ted4" "$out/compact.ted4" && fail differ "one file" || ok differ

"$TED4_BUILD/ted4info" "$out/compact.ted4" --budget >"$out/budget" || fail info "$out/compact.ted4"
check grid "$out/budget" grid
"$TED4_BUILD/ted4dec" --test "$out/compact.ted4" -q && ok decodes || fail decodes "compact.ted4"

version() { od -An -tu1 -j8 -N2 "$out/$1.ted4" | tr -d ' \n'; } # major, minor (spec 5.1)
[ "$(version main) $(version compact)" = '10 12' ] && ok version ||
    fail version "$(version main) $(version compact)"

# Training is stopped in the integer stage, after trials of weights, and resumed. If the program
# ends before it is stopped, it is run again.
long='--profile compact --capacity fixed --set stage1=20 --set stage2=2400 --set capacity_share=0.25'
stop() {
    rm -f "$out/half".*
    "$TED4_BUILD/ted4enc" "$out/pop" -o "$out/half.ted4" $small $long --log "$out/half.log" \
        --checkpoint "$out/half.checkpoint" --checkpoint-every 0 >"$out/half.said" 2>&1 & pid=$!
    i=0
    while [ $i -lt 6000 ] && [ ! -e "$out/half.ted4" ] &&
        ! grep -qs '"stage":"2i"' "$out/half.log"; do sleep 0.05; i=$((i + 1)); done
    kill -TERM $pid 2>/dev/null
    wait $pid
    status=$?
}
train whole $long
for try in 1 2 3 4 5; do
    stop
    [ $status -eq 0 ] || break
done
[ $status -eq 143 ] && ok stopped || fail stopped "status $status: $(cat "$out/half.said")"
train half $long --checkpoint "$out/half.checkpoint" --resume
check goes_on "$out/half.said" 'going on from step '
same resumed whole half
exit $bad
