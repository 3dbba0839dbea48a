#!/bin/sh
# Makes the trained streams of the suite (vectors/content): the project's own scenes, small
# networks, three lambdas. Another version of the encoder, or a machine without fused multiply-add,
# makes other bytes; so the files are stored, and this script documents how they were made.
#     conformance/content.sh FOLDER      writes FOLDER/CNT-*.ted4; TED4_BUILD: programs (build)
set -e
out=$1
bin=${TED4_BUILD:-build}
small="--set max_anchors=800 --set init_anchors=400 --set offsets=4 --set feature=16 --set phi=4
    --set bank_rows=6 --set bank_dim=16 --set deform_width=32 --set head_width=32 --set octaves=6
    --set hyper_layers=1 --set hyper_width=32 --set slices=3 --set ar_width=24 --set stage1=1200
    --set stage2=800"
mkdir -p "$out"
for scene in occluder still pop turn; do
    [ -d "$out/scene-$scene" ] || "$bin/ted4scene" $scene -o "$out/scene-$scene" --size 64x48 \
        --frames 10 --cameras 8 --test-cameras 1 -j 1
    for lambda in 0.0005 0.002 0.008; do
        file=$out/CNT-$scene-$lambda.ted4
        [ -f "$file" ] || "$bin/ted4enc" "$out/scene-$scene" -o "$file" --preset draft \
            --profile main --capacity fixed $small --lambda $lambda --seed 1 -j 1 -q \
            --stage1 "$out/$scene.stage1"
        "$bin/ted4dec" "$file" --test
    done
done
