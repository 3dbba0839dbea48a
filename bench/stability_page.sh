#!/bin/sh
# stability_page.sh - writes bench/stability.md and the SVG charts in bench/lab from the rows of bench/stability.csv that are there. Needs awk alone. The same
# rows give the same bytes.
# Usage, from anywhere:  bench/stability_page.sh [STATES]
#     STATES   a file of lines "STATE TAG", which stability.sh --list prints; asked of that without it
# Environment: TED4_RESULTS (bench: where stability.csv and lab lie and the page goes), TED4_TABLE (bench/stability.txt), TED4_NOTES (bench/stability-notes.md).
# SPDX-License-Identifier: BSD-2-Clause
set -eu
cd "$(dirname "$0")/.."
LC_ALL=C; export LC_ALL
results=${TED4_RESULTS:-bench}
table=${TED4_TABLE:-bench/stability.txt}
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
if [ $# -gt 0 ]; then
    cp "$1" "$scratch/states"
else
    TED4_WORK=$scratch/work TED4_TABLE=$table TED4_RESULTS=$results bench/stability.sh --list >"$scratch/states"
fi
awk -f bench/expand.awk ref-encoder/train/options.def "$table" >"$scratch/wanted"
awk 'FILENAME == ARGV[1] { split($0, word, " "); state[word[2]] = word[1]; next }
     { split($0, part, "|"); print (part[2] in state ? state[part[2]] : "missing") "|" $0 }' "$scratch/states" "$scratch/wanted" >"$scratch/runs"

csv=$results/stability.csv
[ -f "$csv" ] || csv=/dev/null
set --
for part in report/rows report/words report/svg report/axes stability/rules stability/notes stability/marks stability/tables stability/page; do
    set -- "$@" -f bench/$part.awk
done
mkdir "$scratch/charts"
awk "$@" -v charts="$scratch/charts" -v notes="${TED4_NOTES:-bench/stability-notes.md}" "$scratch/runs" "$csv" >"$scratch/stability.md"

mkdir -p "$results/lab"
rm -f "$results"/lab/*.svg
for chart in "$scratch"/charts/*.svg; do
    [ ! -f "$chart" ] || mv "$chart" "$results/lab"
done
mv "$scratch/stability.md" "$results/stability.md"
