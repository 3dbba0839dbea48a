#!/bin/sh
# report.sh - writes bench/report.md and the SVG charts in bench/charts from the rows of bench/sweep.csv that are there, the thinned logs in
# bench/logs and the pages that other measurements keep. `make report`. Needs awk alone. The same rows give the same bytes.
# Usage, from anywhere:  bench/report.sh [STATES]
#     STATES   a file of lines "STATE TAG", which sweep.sh --list prints; asked of that without it
# Environment: TED4_RESULTS (bench: where sweep.csv and logs lie and the report goes), TED4_TABLE (bench/sweep.txt), TED4_PAGES (bench: where raster.md,
# render.md, train.md, memory.md and report-notes.md lie).
# SPDX-License-Identifier: BSD-2-Clause
set -eu
cd "$(dirname "$0")/.."
LC_ALL=C; export LC_ALL
results=${TED4_RESULTS:-bench}
table=${TED4_TABLE:-bench/sweep.txt}
pages=${TED4_PAGES:-bench}
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
if [ $# -gt 0 ]; then
    cp "$1" "$scratch/states"
else
    TED4_WORK=$scratch/work TED4_TABLE=$table TED4_RESULTS=$results bench/sweep.sh --list >"$scratch/states"
fi
awk -f bench/expand.awk ref-encoder/train/options.def "$table" >"$scratch/wanted"
awk 'FILENAME == ARGV[1] { split($0, word, " "); state[word[2]] = word[1]; next }
     { split($0, part, "|"); print (part[2] in state ? state[part[2]] : "missing") "|" $0 }' "$scratch/states" "$scratch/wanted" >"$scratch/runs"

csv=$results/sweep.csv
[ -f "$csv" ] || csv=/dev/null
set --
for part in rows words curves compare svg axes plot dots stacks rate variants singles speed bytes lives estimate kept precision seeds logs page; do
    set -- "$@" -f bench/report/$part.awk
done
mkdir "$scratch/charts"
awk "$@" -v results="$results" -v charts="$scratch/charts" -v pages="$pages" -v notes="$pages/report-notes.md" "$scratch/runs" "$csv" >"$scratch/report.md"

mkdir -p "$results/charts"
rm -f "$results"/charts/*.svg
for chart in "$scratch"/charts/*.svg; do
    [ ! -f "$chart" ] || mv "$chart" "$results/charts"
done
mv "$scratch/report.md" "$results/report.md"
