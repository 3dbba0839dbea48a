#!/bin/sh
# sweep.sh - makes the rows of bench/sweep.csv that bench/sweep.txt wants and that are missing or
# stale: it trains, encodes, decodes and measures. `make sweep`.
# Usage, from anywhere:  bench/sweep.sh [--list] [--missing] [--jobs N] [--threads N] [--only TAG]
#                                       [PATTERN...]
#     PATTERN...   runs of which a group or the tag fits one of these shell patterns; all runs
#                  without any
#     --only TAG   this run
#     --list       says of each run chosen what state it is in and how it is run, and does nothing
#     --missing    leaves rows alone that the same options made with older sources
#     --jobs N     N runs at a time, each of one thread; 1 with all cores without it
#     --threads N  threads of each run instead
# bench/runs.sh tells of keys, and of what happens when this is killed or run several times at once.
# bench/cluster.md tells how to spread the runs over machines; its drivers use these:
#     --build      builds the programs and does nothing else
#     --shared     makes own scenes and the stage 1 that runs share, and no rows; with --list: the
#                  first run of each that is missing
#     --row-files  leaves each row in a file of its own, TED4_WORK/rows/TAG.row
#     --merge      takes these files into the table and does nothing else, as every call without
#                  --row-files does before its runs
# Environment: TED4_BUILD (build), TED4_DATA (../shared/data), TED4_WORK (TED4_BUILD/sweep: what is
# worth keeping between calls), TED4_RESULTS (bench), TED4_TABLE (bench/sweep.txt).
# SPDX-License-Identifier: BSD-2-Clause
set -u
cd "$(dirname "$0")/.." || exit 3
LC_ALL=C; export LC_ALL
program=sweep.sh
build=${TED4_BUILD:-build}
data=${TED4_DATA:-../shared/data}
work=${TED4_WORK:-$build/sweep}
results=${TED4_RESULTS:-bench}
table=${TED4_TABLE:-bench/sweep.txt}
csv=$results/sweep.csv
columns=tag,key,scene,groups,options,lambda,psnr,ssim,ssim2,ms_ssim,bytes
columns=$columns,b_header,b_nete,b_netr,b_bank,b_positions,b_masks,b_feature,b_scaling,b_offset
columns=$columns,b_phi,b_tau,b_frame,motion,activation,temporal_mask
columns=$columns,train_s,stage1_s,cpu_s,stage1_cpu_s,anchors,gaussians,dynamic
columns=$columns,decode_ms,render_fps,estimated_bits,coded_bits
columns=$columns,integer_bits,float32_bits,float64_bits,integer_ms,float32_ms,float64_ms
columns=$columns,span_short,span_between,span_long,changed,short_changed,short_same
columns=$columns,jobs,threads,hash
want="ted4enc ted4dec ted4eval ted4info ted4scene bench/rate_check bench/spans bench/to_jpeg"
jobs=1 threads=0 share=1 judges=
. bench/runs.sh

# What the table keeps of a run besides its row.
keep_pictures() {
    down=$(echo "$options" | sed -n 's/.*--downscale \([0-9]*\).*/\1/p')
    [ -z "$judge" ] || down=1
    sheet=
    case +$keep+ in *+sheet+*) sheet=$out.sheet.png ;; esac
    held=$(echo " $options" | grep -o -E -- ' --hold-out [^ ]+' | tr -d '\n')
    run "$programs/ted4eval" "$out.ted4" "${judge:-$folder}" $held --anyway \
        --downscale "${down:-1}" --json ${sheet:+--sheet "$sheet"} -f -q -j "$threads" \
        >"$out.eval.json" || return 1
    [ -z "$sheet" ] || keep_picture "$sheet" sheets "$tag" || return 1
    spans=
    set -- "$out.ted4"
    case +$keep+ in
    *+spans+*) spans=$out.spans.png; set -- "$@" "$folder" "${down:-1}" "$spans" ;;
    esac
    run "$programs/spans" "$@" >"$out.spans.json" || return 1
    [ -z "$spans" ] || keep_picture "$spans" charts "spans-$tag" || return 1
    case +$keep+ in *+log+*)
        mkdir -p "$results/logs"
        python3 -m bench.pages thin 100 "$first_log" "$out.jsonl" >"$out.log" &&
            mv "$out.log" "$results/logs/$tag.jsonl" || return 1 ;;
    esac
}

measure() {
    first_log=${stage1_file%.stage1}.jsonl
    keep_pictures && time_decoder "$out.ted4" || return 1
    "$programs/ted4info" "$out.ted4" --budget --json >"$out.info.json" || return 1
    "$programs/rate_check" "$out.ted4" >"$out.rate.json" || return 1
    parts=$(python3 -m bench.pages budget "$out.info.json") || return 1
    times=$(python3 -m bench.pages times "$first_log" "$out.jsonl") || return 1
    row=$tag,$key,$scene,$groups,$options,$lambda
    for f in psnr ssim ssim2 ms_ssim bytes; do row=$row,$(value $f "$out.eval.json"); done
    row=$row,$parts
    for f in motion activation temporal_mask; do row=$row,$(value $f "$out.info.json"); done
    row=$row,$times
    for f in anchors gaussians dynamic; do row=$row,$(value $f "$out.json"); done
    row=$row,$decode_ms,$(value render_fps "$out.eval.json")
    for f in estimated_bits coded_bits; do row=$row,$(value $f "$out.json"); done
    for f in integer_bits float32_floored_bits float64_floored_bits integer_ms float32_ms \
        float64_ms; do
        row=$row,$(value $f "$out.rate.json")
    done
    for f in span_short span_between span_long changed short_changed short_same; do
        row=$row,$(value $f "$out.spans.json")
    done
    row=$row,$jobs,$cores,$(value hash "$out.json")
    said="$(value psnr "$out.eval.json") dB, $(value bytes "$out.eval.json") bytes"
}

begin_runs "$@"
