#!/bin/sh
# held_out.sh - makes the rows of bench/held_out.csv that bench/held_out.txt wants and that are
# missing or stale: it makes the scene, trains, decodes and measures. bench/held_out.md, which is
# written by hand, has their means.
# Usage, from anywhere:  bench/held_out.sh [--list] [--missing] [--jobs N] [--threads N]
#                                          [--only TAG] [PATTERN...]
#     PATTERN...   runs of which a group or the tag fits one of these shell patterns; all runs
#                  without any
#     --only TAG   this run (on many machines: bench/cluster.md)
#     --list       says of each run chosen what state it is in and how it is run, and does nothing
#     --missing    leaves rows alone that the same options made with older sources
#     --jobs N     N runs at a time; one without it
#     --threads N  threads of each run; 1 without it
# bench/runs.sh tells of keys, and of what happens when this is killed or run several times at once.
# Environment: TED4_BUILD (build), TED4_DATA (../shared/data), TED4_WORK (TED4_BUILD/held_out: what
# is worth keeping between calls), TED4_RESULTS (bench), TED4_TABLE (bench/held_out.txt).
# SPDX-License-Identifier: BSD-2-Clause
set -u
cd "$(dirname "$0")/.." || exit 3
LC_ALL=C; export LC_ALL
program=held_out.sh
build=${TED4_BUILD:-build}
data=${TED4_DATA:-../shared/data}
work=${TED4_WORK:-$build/held_out}
results=${TED4_RESULTS:-bench}
table=${TED4_TABLE:-bench/held_out.txt}
csv=$results/held_out.csv
columns=tag,key,scene,groups,options,lambda,bytes,psnr,ssim,psnr_moving
columns=$columns,train_psnr,train_psnr_moving,anchors,dynamic,train_s,cpu_s,hash
want="ted4enc ted4eval ted4scene bench/zoo_masks"
jobs=1 threads=1 share= judges=bench/zoo_masks.c
. bench/runs.sh

# A number of a JSON file; nothing where it is not finite.
known() { value "$@" | sed 's/^null$//'; }

# psnr_moving: of held-out pictures, by frame differences, where cameras stand still.
# train_psnr_moving: of training pictures, in the masks of scenes that have them.
measure() {
    down=$(echo "$options" | sed -n 's/.*--downscale \([0-9]*\).*/\1/p')
    set -- "$out.ted4" "$folder" --anyway --downscale "${down:-1}" --json -j "$threads"
    run "$programs/ted4eval" "$@" --moving -q >"$out.eval.json" || return 1
    rm -rf "$out.pictures"
    : >"$out.train.json"
    : >"$out.masks.json"
    if [ -d "$folder/truth/masks" ]; then
        run "$programs/ted4eval" "$@" --split train -v --images "$out.pictures" \
            >"$out.train.json" 2>"$out.views" || return 1
        "$programs/zoo_masks" "$folder" "$out.pictures" <"$out.views" >"$out.masks.json" ||
            return 1
        rm -rf "$out.pictures"
    fi
    times=$(python3 -m bench.pages times "$out.jsonl") || return 1
    row=$tag,$key,$scene,$groups,$options,$lambda
    for f in bytes psnr ssim psnr_moving; do row=$row,$(known $f "$out.eval.json"); done
    row=$row,$(known psnr "$out.train.json"),$(known moving_psnr "$out.masks.json")
    for f in anchors dynamic; do row=$row,$(value $f "$out.json"); done
    row=$row,$(echo "$times" | cut -d, -f1,3),$(value hash "$out.json")
    said="$(value psnr "$out.eval.json") dB, $(value bytes "$out.eval.json") bytes"
}

begin_runs "$@"
