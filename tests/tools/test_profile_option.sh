#!/bin/sh
# test_profile_option.sh - ted4enc --profile compact: it stands for options of training, which
# --iterations and --set replace; its file says the profile, lies on the grid of positions, and is
# the same where training was stopped and went on. Prints lines as a cmocka program does; run by
# `make test` from the project's root.
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

train compact --profile compact --iterations 60,40
train options --set profile=1 --set stage2=40
train back    --profile compact --iterations 60,40 --set profile=0
train main    --profile main --iterations 60,40
train plain   --set stage2=40
same  options_of_compact compact options
same  main_is_default main plain
same  set_wins main back

# Stage 2 is three times as long as that of the preset, which has 5000 steps.
: >"$out/long"
"$TED4_BUILD/ted4enc" "$out/pop" -o "$out/long.ted4" $small --profile compact --log "$out/log" \
    -v >"$out/long" 2>&1 & pid=$!
i=0
while [ $i -lt 600 ] && ! grep -q '/[0-9]* stage' "$out/long"; do sleep 0.1; i=$((i + 1)); done
kill -TERM $pid 2>/dev/null; wait $pid
check longer "$out/long" '/15060 stage'

"$TED4_BUILD/ted4info" "$out/compact.ted4" --budget >"$out/budget" || fail info "$out/compact.ted4"
check grid "$out/budget" grid
"$TED4_BUILD/ted4dec" --test "$out/compact.ted4" -q && ok decodes || fail decodes "compact.ted4"

# Stopped in the middle of stage 2, after trials of weights, and resumed.
train whole --profile compact --capacity fixed --set stage2=2400 --set capacity_share=0.25 \
    --set stage1=20
"$TED4_BUILD/ted4enc" "$out/pop" -o "$out/half.ted4" $small --profile compact --capacity fixed \
    --set stage2=2400 --set capacity_share=0.25 --set stage1=20 \
    --checkpoint "$out/half.checkpoint" --checkpoint-every 0 >"$out/half.said" 2>&1 & pid=$!
i=0
while [ $i -lt 600 ] && [ ! -s "$out/half.checkpoint" ]; do sleep 0.1; i=$((i + 1)); done
sleep 1
kill -TERM $pid 2>/dev/null; wait $pid
train half --profile compact --capacity fixed --set stage2=2400 --set capacity_share=0.25 \
    --set stage1=20 --checkpoint "$out/half.checkpoint" --resume
same resumed whole half
exit $bad
