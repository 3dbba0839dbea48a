#!/bin/sh
# test_meant.sh - after a misspelt name the message suggests the name that may have been meant, and
# if a run is resumed with options other than the checkpoint's, it names the option that differs.
# Prints lines as a cmocka program does; run by `make test` from the project's root.
# SPDX-License-Identifier: BSD-2-Clause
set -u
. tests/support/speak.sh
need meant ted4enc ted4dec ted4scene
enc=$TED4_BUILD/ted4enc
# no_hint NAME STATUS TEXT COMMAND...: like expect, but nothing may be suggested.
no_hint() { expect "$@"; ! grep -q 'did you mean' "$out/said" && ok "$1_no_hint" ||
    fail "$1_no_hint" "$(cat "$out/said")"; }

expect set_left_out 3 \
    'laambda=1: expected name=value with a name from --help; did you mean lambda?' "$enc" x \
    -o "$out/x.ted4" --set laambda=1
expect set_turned 3 'did you mean stage2?' "$enc" x -o "$out/x.ted4" --set stgae2=1
no_hint set_far 3 'zzz: expected name=value' "$enc" x -o "$out/x.ted4" --set zzz
no_hint set_value 3 'lambda=11: expected a number' "$enc" x -o "$out/x.ted4" --set lambda=11
no_hint set_integer 3 'stage1=x: expected an integer from 1 to 10000000' "$enc" x -o "$out/x.ted4" \
    --set stage1=x
expect preset 3 'or paper; did you mean medium?' "$enc" x -o "$out/x.ted4" --preset medum
no_hint preset_far 3 'or paper' "$enc" x -o "$out/x.ted4" --preset best
expect long_option 3 'did you mean --checkpoint?' "$enc" x -o "$out/x.ted4" --chekpoint=c
expect decoder 3 'did you mean --hash?' "$TED4_BUILD/ted4dec" x --hsah
no_hint argument 3 'requires an argument' "$enc" x -o "$out/x.ted4" --checkpoint
no_hint letter 3 'invalid option' "$enc" x -o "$out/x.ted4" -Z

small="--preset draft --iterations 60,40 --seed 1 -j 1 -q --set init_anchors=100
    --set max_anchors=150 --set offsets=4 --set feature=8 --set deform_width=8 --set head_width=12
    --set hyper_width=16 --set ar_width=8 --set slices=2 --checkpoint $out/c -f"
"$TED4_BUILD/ted4scene" pop -o "$out/scene" --size 32x24 --frames 4 --cameras 5 --test-cameras 1 \
    -j 1 2>/dev/null
"$TED4_BUILD/ted4scene" pop -o "$out/other" --size 32x24 --frames 4 --cameras 5 --test-cameras 1 \
    -j 1 --seed 2 2>/dev/null
"$enc" "$out/scene" -o "$out/x.ted4" $small || fail encode "status $?"
differs() { name=$1 text=$2 scene=$3; shift 3;
    expect "$name" 3 "with these options: $text" "$enc" "$out/$scene" -o "$out/x.ted4" $small \
    --resume "$@"; }
differs value 'its lambda is 0.002, and 0.004 is asked for' scene --lambda 0.004
differs first_of_two 'its feature is 8, and 12 is asked for' scene --set feature=12 --set slices=4
differs seed 'its seed is 1, and 7 is asked for' scene --seed 7
differs size 'it is of other pictures' scene --downscale 2
differs times 'it is of 24 pictures, and there are 12' scene --max-frames 2
differs scene 'it is of other pictures' other
"$enc" "$out/scene" -o "$out/x.ted4" $small --resume && ok same || fail same "status $?"
exit $bad
