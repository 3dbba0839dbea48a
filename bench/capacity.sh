#!/bin/sh
# capacity.sh - makes the rows of bench/capacity.csv that bench/capacity.txt wants and that are
# missing or stale: it makes the scene, trains, decodes and measures. `make capacity` does that and
# writes the page.
# Usage, from anywhere:  bench/capacity.sh [--list] [--missing] [--jobs N] [--threads N]
#                                          [--only TAG] [PATTERN...]
#     PATTERN...   runs of which a group or the tag fits one of these shell patterns; all runs
#                  without any
#     --only TAG   this run (on many machines: bench/cluster.md)
#     --list       says of each run chosen what state it is in and how it is run, and does nothing
#     --missing    leaves rows alone that the same options made with older sources
#     --jobs N     N runs at a time; as many as there are cores without it
#     --threads N  threads of each run; 1 without it
# bench/runs.sh tells of keys, and of what happens when this is killed or run several times at once.
# Environment: TED4_BUILD (build), TED4_DATA (../shared/data), TED4_WORK (TED4_BUILD/capacity: what
# is worth keeping between calls), TED4_RESULTS (bench), TED4_TABLE (bench/capacity.txt).
# SPDX-License-Identifier: BSD-2-Clause
set -u
cd "$(dirname "$0")/.." || exit 3
LC_ALL=C; export LC_ALL
program=capacity.sh
build=${TED4_BUILD:-build}
data=${TED4_DATA:-../shared/data}
work=${TED4_WORK:-$build/capacity}
results=${TED4_RESULTS:-bench}
table=${TED4_TABLE:-bench/capacity.txt}
csv=$results/capacity.csv
shape="n_offsets feature_dim motion phi_dim bank_rows bank_dim deform_layers deform_width"
shape="$shape activation view head_layers head_width scale_domain pe_octaves hyper_layers"
shape="$shape hyper_width n_slices ar_width"
columns=tag,key,scene,groups,options,lambda,bytes,psnr,ssim,l1
columns=$columns,b_header,b_nete,b_netr,b_bank,b_positions,b_masks,b_feature,b_scaling,b_offset
columns=$columns,b_phi,b_tau,b_frame,$(echo "$shape" | tr ' ' ,)
columns=$columns,anchors,gaussians,dynamic,train_s,cpu_s,trial_steps,decode_ms,hash
want="ted4enc ted4dec ted4eval ted4info ted4scene"
jobs=$(getconf _NPROCESSORS_ONLN) threads=1 share= judges=
. bench/runs.sh

measure() {
    down=$(echo "$options" | sed -n 's/.*--downscale \([0-9]*\).*/\1/p')
    run "$programs/ted4eval" "$out.ted4" "$folder" --anyway --downscale "${down:-1}" --json -q \
        -j "$threads" >"$out.eval.json" || return 1
    "$programs/ted4info" "$out.ted4" --budget --json >"$out.info.json" || return 1
    time_decoder "$out.ted4" || return 1
    parts=$(python3 -m bench.pages budget "$out.info.json") || return 1
    times=$(python3 -m bench.pages times "$out.jsonl") || return 1
    row=$tag,$key,$scene,$groups,$options,$lambda
    for f in bytes psnr ssim l1; do row=$row,$(value $f "$out.eval.json"); done
    row=$row,$parts
    for f in $shape; do row=$row,$(value $f "$out.info.json"); done
    for f in anchors gaussians dynamic; do row=$row,$(value $f "$out.json"); done
    row=$row,$(echo "$times" | cut -d, -f1,3)
    row=$row,$(sed -n 's/.*"event":"capacity".*"trained":\([0-9]*\).*/\1/p' "$out.jsonl" |
        awk '{ n += $1 } END { print n + 0 }')
    row=$row,$decode_ms,$(value hash "$out.json")
    said="$(value psnr "$out.eval.json") dB, $(value bytes "$out.eval.json") bytes"
}

begin_runs "$@"
