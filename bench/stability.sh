#!/bin/sh
# stability.sh - makes the rows of bench/stability.csv that bench/stability.txt wants and that are
# missing or stale: it makes the scene, trains, decodes and measures. `make stability` does that and
# writes the page.
# Usage, from anywhere:  bench/stability.sh [--list] [--missing] [--jobs N] [--threads N]
#                                           [--only TAG] [PATTERN...]
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
# (../shared/data), TED4_WORK (TED4_BUILD/stability: what is worth keeping between calls),
# TED4_RESULTS (bench), TED4_TABLE (bench/stability.txt).
# SPDX-License-Identifier: BSD-2-Clause
set -u
cd "$(dirname "$0")/.." || exit 3
LC_ALL=C; export LC_ALL
program=stability.sh
build=${TED4_BUILD:-build}
data=${TED4_DATA:-../shared/data}
work=${TED4_WORK:-$build/stability}
results=${TED4_RESULTS:-bench}
table=${TED4_TABLE:-bench/stability.txt}
csv=$results/stability.csv
facts="views exact refused_views psnr worst worst_frame worst_camera bytes anchors gaussians"
facts="$facts dynamic drawn out out_share displacement displacement_99 refused_times dead full"
facts="$facts thin huge symbols escapes escape_share symbol_ends sigma_ends step_ends context_ends"
facts="$facts width_ends log_bad loss_first loss_last diverged gradient gradient_term peak"
facts="$facts peak_term rollbacks skipped clamped"
columns=tag,key,scene,groups,options,status,$(echo "$facts" | tr ' ' ,),train_s,cpu_s,hash,why
want="ted4enc ted4scene bench/lab_facts bench/to_jpeg"
jobs=$(getconf _NPROCESSORS_ONLN) threads=1 share= judges="$(echo bench/lab_*.[ch])"
. bench/runs.sh

measure() {
    set -- "$out.ted4" "$folder" "$out.jsonl"
    case +$keep+ in *+strip+*) strip=$out.strip.png; set -- "$@" "$strip" ;; *) strip= ;; esac
    run "$programs/lab_facts" "$@" >"$out.facts.json" || return 1
    [ -z "$strip" ] || keep_picture "$strip" lab "$tag" || return 1
    times=$(python3 -m bench.pages times "$out.jsonl") || return 1
    row=$tag,$key,$scene,$groups,$options,fine
    for f in $facts; do row=$row,$(value $f "$out.facts.json" | sed 's/^null$//'); done
    row=$row,$(echo "$times" | cut -d, -f1,3),$(value hash "$out.json"),
    said="$(value psnr "$out.facts.json") dB, worst $(value worst "$out.facts.json")"
    said="$said, $(value bytes "$out.facts.json") bytes"
}

measure_failure() {
    ended=$(status_word "$1") || return 1
    row=$tag,$key,$scene,$groups,$options,$ended
    for f in $facts; do row=$row,; done
    row=$row,,,,$(last_words)
    said="$ended: $(tail -n 1 "$out.err")"
}

begin_runs "$@"
