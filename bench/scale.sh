#!/bin/sh
# scale.sh BUILD SCENE: what many cores can make of training steps at half and at full size, and of
# two whole runs: a short one of SCENE, and the demo's.
set -e
build=$1
scene=$2
quarter="--downscale 2 --set stage1=2250 --set stage2=1250"
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
"$build/bench/bench_scale" "$scene" 2
echo
"$build/bench/bench_scale" "$scene" 1
run() {
    "$build/bench/phases" "$1" -o "$out/x.ted4" -f --quiet --checkpoint "$out/x.ck" \
        --log "$out/x.jsonl" --seed 1 --preset draft $2
}
echo
echo "ted4enc $(basename "$scene") --preset draft $quarter: 35 % of the preset's steps"
run "$scene" "$quarter"
echo
echo "the demo: ted4enc occluder --preset draft"
"$build/ted4scene" occluder -o "$out/occluder" -f >"$out/scene.txt"
run "$out/occluder" ""
