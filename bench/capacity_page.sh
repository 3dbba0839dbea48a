#!/bin/sh
# capacity_page.sh - writes bench/capacity.md from the rows of bench/capacity.csv that are there. Needs awk alone. The same rows give the same bytes.
# Usage, from anywhere:  bench/capacity_page.sh [STATES]
#     STATES   a file of lines "STATE TAG", which capacity.sh --list prints; asked of that without it
# Environment: TED4_RESULTS (bench: where capacity.csv lies and the page goes), TED4_TABLE (bench/capacity.txt).
# SPDX-License-Identifier: BSD-2-Clause
set -eu
cd "$(dirname "$0")/.."
LC_ALL=C; export LC_ALL
results=${TED4_RESULTS:-bench}
table=${TED4_TABLE:-bench/capacity.txt}
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
if [ $# -gt 0 ]; then
    cp "$1" "$scratch/states"
else
    TED4_WORK=$scratch/work TED4_TABLE=$table TED4_RESULTS=$results bench/capacity.sh --list >"$scratch/states"
fi
awk -f bench/expand.awk ref-encoder/train/options.def "$table" >"$scratch/wanted"
awk 'FILENAME == ARGV[1] { split($0, word, " "); state[word[2]] = word[1]; next }
     { split($0, part, "|"); print (part[2] in state ? state[part[2]] : "missing") "|" $0 }' "$scratch/states" "$scratch/wanted" >"$scratch/runs"

csv=$results/capacity.csv
[ -f "$csv" ] || csv=/dev/null
awk -f bench/report/rows.awk -f bench/report/words.awk -f bench/capacity/cost.awk -f bench/capacity/page.awk "$scratch/runs" "$csv" >"$scratch/capacity.md"
mv "$scratch/capacity.md" "$results/capacity.md"
