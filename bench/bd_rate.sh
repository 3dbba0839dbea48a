#!/bin/sh
# bd_rate.sh - makes the rows of bench/bd_rate.csv that bench/bd_rate.txt wants and that are missing
# or stale: it makes the scene, trains, decodes and measures. `make bd-rate` does that and writes
# the tables of bench/bd_rate.md.
# Usage, from anywhere:  bench/bd_rate.sh [--list] [--missing] [--jobs N] [--threads N]
#                                         [--only TAG] [PATTERN...]
#     PATTERN...   runs of which a group or the tag fits one of these shell patterns; all runs
#                  without any
#     --only TAG   this run (on many machines: bench/cluster.md)
#     --list       says of each run chosen what state it is in and how it is run, and does nothing
#     --missing    leaves rows alone that the same options made with older sources
#     --jobs N     N runs at a time; one without it
#     --threads N  threads of each run; 1 without it
# bench/runs.sh tells of keys, and of what happens when this is killed or run several times at once.
# Environment: TED4_BUILD (build), TED4_DATA (../shared/data), TED4_WORK (TED4_BUILD/bd_rate: what
# is worth keeping between calls), TED4_RESULTS (bench), TED4_TABLE (bench/bd_rate.txt).
# SPDX-License-Identifier: BSD-2-Clause
set -u
cd "$(dirname "$0")/.." || exit 3
LC_ALL=C; export LC_ALL
program=bd_rate.sh
build=${TED4_BUILD:-build}
data=${TED4_DATA:-../shared/data}
work=${TED4_WORK:-$build/bd_rate}
results=${TED4_RESULTS:-bench}
table=${TED4_TABLE:-bench/bd_rate.txt}
csv=$results/bd_rate.csv
columns=tag,key,scene,groups,options,lambda,bytes,psnr,ssim
columns=$columns,b_header,b_nete,b_netr,b_bank,b_positions,b_masks,b_feature,b_scaling,b_offset
columns=$columns,b_phi,b_tau,b_frame
columns=$columns,anchors,gaussians,dynamic,train_s,cpu_s,estimated_bits,coded_bits,decode_ms,hash
want="ted4enc ted4dec ted4eval ted4info ted4scene"
jobs=1 threads=1 share=1 judges=
. bench/runs.sh

measure() {
    down=$(echo "$options" | sed -n 's/.*--downscale \([0-9]*\).*/\1/p')
    run "$programs/ted4eval" "$out.ted4" "$folder" --anyway --downscale "${down:-1}" --json -q \
        -j "$threads" >"$out.eval.json" || return 1
    "$programs/ted4info" "$out.ted4" --budget --json >"$out.info.json" || return 1
    time_decoder "$out.ted4" || return 1
    parts=$(python3 -m bench.pages budget "$out.info.json") || return 1
    times=$(python3 -m bench.pages times "${stage1_file%.stage1}.jsonl" "$out.jsonl") || return 1
    row=$tag,$key,$scene,$groups,$options,$lambda
    for f in bytes psnr ssim; do row=$row,$(value $f "$out.eval.json"); done
    row=$row,$parts
    for f in anchors gaussians dynamic; do row=$row,$(value $f "$out.json"); done
    row=$row,$(echo "$times" | cut -d, -f1,3)
    for f in estimated_bits coded_bits; do row=$row,$(value $f "$out.json"); done
    row=$row,$decode_ms,$(value hash "$out.json")
    said="$(value psnr "$out.eval.json") dB, $(value bytes "$out.eval.json") bytes"
}

begin_runs "$@"
