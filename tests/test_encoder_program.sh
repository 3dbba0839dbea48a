#!/bin/sh
# test_encoder_program.sh - spec 3.4 asked of the program ted4enc by `ted4conf encode`, for a scene that moves and one that does not; and `ted4conf encode` sees
# through encoders that do not conform (conformance/tests/bad_encoder.sh). Speaks as cmocka programs do; run by `make test` from the project's root.
# SPDX-License-Identifier: BSD-2-Clause
set -u
export LC_ALL=C
for program in ted4conf ted4enc ted4scene; do
    if [ ! -x "${TED4_BUILD:-}/$program" ]; then
        echo "skipped: TED4_BUILD has no $program"
        echo "[  SKIPPED ] encoder_program"
        exit 0
    fi
done
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
bad=0
short='--set stage1=60 --set stage2=40 --set max_anchors=300 --set init_anchors=200 --set feature=8 --set deform_width=16 --set head_width=16
    --set hyper_width=16 --set ar_width=8 --set slices=2 -j 2 --seed 1'
short=$(echo $short)

ok()   { echo "[       OK ] $1"; }
fail() { echo "[  FAILED  ] $1: $2"; bad=1; }
# judge NAME WANTED-STATUS WANTED-TEXT ARGUMENTS...
judge() {
    name=$1 wanted=$2 text=$3
    shift 3
    "$TED4_BUILD/ted4conf" encode "$@" >"$out/said" 2>&1
    status=$?
    if [ $status -eq "$wanted" ] && grep -qF -- "$text" "$out/said"; then ok "$name"; else fail "$name" "status $status: $(cat "$out/said")"; fi
}

for scene in pop still; do
    "$TED4_BUILD/ted4scene" $scene -o "$out/$scene" --size 32x24 --frames 4 --cameras 5 --test-cameras 1 -j 2 2>/dev/null
    judge "conforms_$scene" 0 ': conforms' -e "'$TED4_BUILD/ted4enc' $short" --preset draft "$out/$scene"
done
judge no_scene 1 'no answer' -e "'$TED4_BUILD/ted4enc'" "$out/absent"

# A file and its answer for the bad ones; WASTE: a vector that is valid and codes what it does not need (R-ENC-004).
MADE=$out/made WASTE=$out/waste
cp conformance/vectors/worked/WRK-annex-b1.ted4 "$MADE"
cp conformance/vectors/valid/levels/LVL-frames-65.ted4 "$WASTE"
export MADE WASTE
for file in "$MADE" "$WASTE"; do
    hash=$("$TED4_BUILD/ted4dec" "$file" --hash | sed -n "s/^ends //p")
    echo "{\"hash\":\"$hash\"}" >"$file.json"
done
bad() { judge "$1" "$2" "$3" -t 5 -e 'sh conformance/tests/bad_encoder.sh '"$1" "$out/pop"; }
bad good 0 ': conforms'
bad no-file 1 'there is no file'
bad broken 1 'con.truncated'
bad level-too-low 1 'lvl.exceeded'
bad other-hash 1 'another hash'
bad no-hash 1 'another hash'
bad wasteful 1 'adv.'
for way in crash hang silent exit-code chatter; do
    bad $way 1 'no answer'
done
exit $bad
