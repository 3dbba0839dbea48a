#!/bin/sh
# test_encoder_program.sh - spec 3.4, tested with the program ted4enc by `ted4conf encode`, for a
# scene that moves and one that does not; also, `ted4conf encode` detects encoders that do not
# conform (conformance/tests/bad_encoder.sh). Prints lines as a cmocka program does; run by `make
# test` from the project's root.
# SPDX-License-Identifier: BSD-2-Clause
set -u
export LC_ALL=C
. tests/support/speak.sh
need encoder_program ted4conf ted4enc ted4dec ted4scene
short='--set stage1=60 --set stage2=40 --set max_anchors=300 --set init_anchors=200
    --set feature=8 --set deform_width=16 --set head_width=16 --set hyper_width=16
    --set ar_width=8 --set slices=2 -j 2 --seed 1'
short=$(echo $short)

for scene in pop still; do
    "$TED4_BUILD/ted4scene" $scene -o "$out/$scene" --size 32x24 --frames 4 --cameras 5 \
        --test-cameras 1 -j 2 2>/dev/null
    expect "conforms_$scene" 0 ': conforms' "$TED4_BUILD/ted4conf" encode \
        -e "'$TED4_BUILD/ted4enc' $short" --preset draft "$out/$scene"
done
expect bad_jobs 3 'ted4conf: --jobs: bad value 0; expected a whole number from 1 to 200' \
    "$TED4_BUILD/ted4conf" run -d false -j 0
expect bad_timeout 3 'ted4conf: --timeout: bad value 1s; expected a whole number from 1 to 86400' \
    "$TED4_BUILD/ted4conf" run -d false -t 1s
expect no_scene 1 'no answer' "$TED4_BUILD/ted4conf" encode -e "'$TED4_BUILD/ted4enc'" "$out/absent"

# A file and its answer for the bad encoders. WASTE: a vector that is valid but codes something
# unnecessary (R-ENC-004).
MADE=$out/made WASTE=$out/waste
cp conformance/vectors/worked/WRK-annex-b1.ted4 "$MADE"
cp conformance/vectors/valid/levels/LVL-frames-65.ted4 "$WASTE"
export MADE WASTE
for file in "$MADE" "$WASTE"; do
    hash=$("$TED4_BUILD/ted4dec" "$file" --hash | sed -n "s/^ends //p")
    echo "{\"hash\":\"$hash\"}" >"$file.json"
done
bad() { expect "$1" "$2" "$3" "$TED4_BUILD/ted4conf" encode -t 5 \
    -e 'sh conformance/tests/bad_encoder.sh '"$1" "$out/pop"; }
bad good 0 ': conforms'
for way in no-file pipe folder; do
    bad $way 1 'there is no file'
done
bad broken 1 'con.truncated'
bad level-too-low 1 'lvl.exceeded'
bad other-hash 1 'another hash'
bad no-hash 1 'another hash'
bad wasteful 1 'adv.'
for way in crash hang silent exit-code chatter; do
    bad $way 1 'no answer'
done
exit $bad
