#!/bin/sh
# zoo_page.sh - writes bench/zoo.md from the rows of bench/zoo.csv that are there. Needs awk alone.
# The same rows give the same bytes.
# Usage, from anywhere:  bench/zoo_page.sh [STATES]
#     STATES   a file of lines "STATE TAG", which zoo.sh --list prints; asked of that without it
# Environment: TED4_RESULTS (bench: where zoo.csv lies and the page goes), TED4_TABLE (bench/zoo.txt).
# SPDX-License-Identifier: BSD-2-Clause
set -eu
cd "$(dirname "$0")/.."
results=${TED4_RESULTS:-bench}
table=${TED4_TABLE:-bench/zoo.txt}
. bench/page.sh
wanted_runs bench/zoo.sh "$@"
write_page "$results/zoo.md" "$results/zoo.csv" "$results/zoo" "report/rows report/words zoo/page" \
    -v cases="$table" -v notes="${TED4_NOTES:-bench/zoo-notes.md}"
