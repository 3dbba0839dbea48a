# page.sh - from a table of wanted runs and its rows to a page with SVG charts: what bench/report.sh, bench/stability_page.sh and bench/capacity_page.sh
# share. Sourced from the project's root with $results (folder of rows and page) and $table (of wanted runs) set.
# SPDX-License-Identifier: BSD-2-Clause
LC_ALL=C; export LC_ALL
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
mkdir "$scratch/charts"

# wanted_runs HARNESS [STATES]: $scratch/runs, a line "STATE|RUN" for each run that bench/expand.awk makes of the table. STATES: a file of lines "STATE TAG", which
# HARNESS --list prints; asked of that without it.
wanted_runs() {
    if [ $# -gt 1 ]; then
        cp "$2" "$scratch/states"
    else
        TED4_WORK=$scratch/work TED4_TABLE=$table TED4_RESULTS=$results "$1" --list >"$scratch/states"
    fi
    awk -f bench/expand.awk ref-encoder/train/model/options.def "$table" >"$scratch/wanted"
    awk 'FILENAME == ARGV[1] { split($0, word, " "); state[word[2]] = word[1]; next }
         { split($0, part, "|"); print (part[2] in state ? state[part[2]] : "missing") "|" $0 }' "$scratch/states" "$scratch/wanted" >"$scratch/runs"
}

# write_page PAGE CSV CHARTS PARTS [AWK-OPTION...]: bench/PARTS.awk read the runs and the rows, and print the page; its charts take the place of those in CHARTS.
# Nothing is replaced unless they all succeed.
write_page() {
    page=$1 csv=$2 folder=$3 parts=$4; shift 4
    [ -f "$csv" ] || csv=/dev/null
    for part in $parts; do
        set -- "$@" -f "bench/$part.awk"
    done
    awk "$@" -v charts="$scratch/charts" "$scratch/runs" "$csv" >"$scratch/page.md"
    mkdir -p "$folder"
    rm -f "$folder"/*.svg
    for chart in "$scratch"/charts/*.svg; do
        [ ! -f "$chart" ] || mv "$chart" "$folder"
    done
    mv "$scratch/page.md" "$page"
}
