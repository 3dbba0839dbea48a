#!/bin/sh
# zoo.sh - makes the rows of bench/zoo.csv that bench/zoo.txt wants and that are missing or stale:
# it makes the scene, trains, decodes and measures. `make zoo` does that and writes the page. Runs
# of the group alone tell how well ted4enc foresees how long it takes; they want --jobs 1 --threads
# 0, and nothing beside them.
# Usage, from anywhere:  bench/zoo.sh [--list] [--missing] [--jobs N] [--threads N] [--only TAG]
#                                     [PATTERN...]
#     PATTERN...   runs of which a group or the tag fits one of these shell patterns; all runs
#                  without any
#     --only TAG   this run (on many machines: bench/cluster.md)
#     --list       says of each run chosen what state it is in and how it is run, and does nothing
#     --missing    leaves rows alone that the same options made with older sources
#     --jobs N     N runs at a time; as many as there are cores without it
#     --threads N  threads of each run; 1 without it
# A training that ends by itself without a file is a result, too: it gives a row whose status is
# error or crash and whose last column is what ted4enc said. To try again, remove the row. A
# training that is killed gives no row. bench/runs.sh tells of keys, and of what happens when this
# is killed or run several times at once. Environment: TED4_BUILD (build), TED4_DATA
# (../shared/data), TED4_WORK (TED4_BUILD/zoo: what is worth keeping between calls), TED4_RESULTS
# (bench), TED4_TABLE (bench/zoo.txt).
# SPDX-License-Identifier: BSD-2-Clause
set -u
cd "$(dirname "$0")/.." || exit 3
LC_ALL=C; export LC_ALL
program=zoo.sh
build=${TED4_BUILD:-build}
data=${TED4_DATA:-../shared/data}
work=${TED4_WORK:-$build/zoo}
results=${TED4_RESULTS:-bench}
table=${TED4_TABLE:-bench/zoo.txt}
csv=$results/zoo.csv
columns=tag,key,scene,groups,options,status,exit,psnr,train_psnr,moving_psnr,moving_pixels,bytes
columns=$columns,anchors,steps,rollbacks,warnings,train_s,cpu_s
columns=$columns,estimate_low,estimate_high,last_psnr,last_bytes,hash,why
want="ted4enc ted4eval ted4scene bench/zoo_masks"
jobs=$(getconf _NPROCESSORS_ONLN) threads=1 share= judges=bench/zoo_masks.c
. bench/runs.sh

# Options that say what is read of the scene, as ted4enc and ted4eval both have them.
reading() { echo " $options" | grep -o -E -- ' --(alpha|hold-out|downscale) [^ ]+' | tr -d '\n'; }

# A number of a JSON file; nothing where it is not finite.
known() { value "$@" | sed 's/^null$//'; }

# Pictures of training are looked at where they show what moves, as far as the scene has masks.
measure() {
    run "$programs/ted4eval" "$out.ted4" "$folder" $(reading) --anyway --json -q -j "$threads" \
        >"$out.eval.json" || return 1
    rm -rf "$out.pictures"
    run "$programs/ted4eval" "$out.ted4" "$folder" $(reading) --anyway --split train --json -v \
        --images "$out.pictures" -j "$threads" >"$out.train.json" 2>"$out.views" || return 1
    "$programs/zoo_masks" "$folder" "$out.pictures" <"$out.views" >"$out.masks.json" || return 1
    rm -rf "$out.pictures"
    times=$(python3 -m bench.pages times "$out.jsonl") || return 1
    told=$(python3 -m bench.pages predicted "$(value train_s "$out.json")" "$out.jsonl") || return 1
    warnings=$(grep -c 'warning:' "$out.err")
    row=$tag,$key,$scene,$groups,$options,fine,0
    row=$row,$(known psnr "$out.eval.json"),$(known psnr "$out.train.json")
    row=$row,$(known moving_psnr "$out.masks.json")
    row=$row,$(value moving_pixels "$out.masks.json")
    for f in bytes anchors steps rollbacks; do row=$row,$(value $f "$out.json"); done
    row=$row,$warnings,$(echo "$times" | cut -d, -f1,3),$told,$(value hash "$out.json"),
    said="$(value psnr "$out.eval.json") dB, training $(value psnr "$out.train.json")"
    said="$said, what moves $(value moving_psnr "$out.masks.json")"
}

measure_failure() {
    ended=$(status_word "$1") || return 1
    row=$tag,$key,$scene,$groups,$options,$ended,$1,,,,,,,,,,,,,,,,,$(last_words)
    said="$ended: $(tail -n 1 "$out.err")"
}

begin_runs "$@"
