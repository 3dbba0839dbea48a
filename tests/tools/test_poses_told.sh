#!/bin/sh
# test_poses_told.sh - ted4enc says once, on the terminal and in its log, whether it refines the
# poses of cameras, in a resumed run as well. Prints lines as a cmocka program does; run by `make
# test` from the project's root.
# SPDX-License-Identifier: BSD-2-Clause
set -u
. tests/support/speak.sh
need poses_told ted4enc ted4scene
# equal NAME VALUE WANTED
equal() { if [ "$2" = "$3" ]; then ok "$1"; else fail "$1" "$2, expected $3"; fi; }
small="--preset draft --iterations 1000,50 --seed 1 -j 1 --capacity fixed --set probe=0
    --set init_anchors=300 --set max_anchors=500 --set offsets=4 --set feature=8 --set phi=4
    --set bank_dim=8 --set deform_width=8 --set head_width=12"

# encode SCENE NAME [OPTION...]
encode() {
    scene=$1 name=$2; shift 2
    "$TED4_BUILD/ted4enc" "$out/$scene" -o "$out/$name.ted4" --log "$out/$name.jsonl" $small "$@" \
        -f 2>"$out/$name.err" || fail "$name" "$(cat "$out/$name.err")"
}
# The log has true or false for each decision.
logged() {
    sed -n 's/.*"event":"poses","rollbacks":0,"moved":[0-9.]*,"refined":\([a-z]*\)}$/\1/p' \
        "$out/$1.jsonl" | tr '\n' ' '
}

for scene in shaken turn; do
    "$TED4_BUILD/ted4scene" $scene -o "$out/$scene" --size 96x64 --frames 4 --cameras 6 \
        --test-cameras 1 -j 1 2>/dev/null
done
encode shaken wrong --checkpoint "$out/wrong.checkpoint"
equal wrong "$(logged wrong)" "true "
equal wrong_said "$(grep -c 'poses: .* pixels, and goes on$' "$out/wrong.err")" 1
encode turn right
equal right "$(logged right)" "false "
equal right_said "$(grep -c 'poses: .* pixels only; as given$' "$out/right.err")" 1
encode shaken off --set poses=0
equal off "$(logged off)" ""
equal off_said "$(grep -c 'poses:' "$out/off.err")" 0

# A run that is resumed after the decision does not say it again, and the log keeps it.
cp "$out/wrong.ted4" "$out/first.ted4"
encode shaken wrong --checkpoint "$out/wrong.checkpoint" --resume
equal resumed "$(logged wrong)" "true "
equal resumed_said "$(grep -c 'poses:' "$out/wrong.err")" 0
cmp -s "$out/wrong.ted4" "$out/first.ted4" && ok resumed_file || fail resumed_file "another file"
exit $bad
