#!/bin/sh
# stability_page.sh - writes bench/stability.md and the SVG charts in bench/lab from the rows of bench/stability.csv that are there. Needs awk alone. The same
# rows give the same bytes.
# Usage, from anywhere:  bench/stability_page.sh [STATES]
#     STATES   a file of lines "STATE TAG", which stability.sh --list prints; asked of that without it
# Environment: TED4_RESULTS (bench: where stability.csv and lab lie and the page goes), TED4_TABLE (bench/stability.txt), TED4_NOTES (bench/stability-notes.md).
# SPDX-License-Identifier: BSD-2-Clause
set -eu
cd "$(dirname "$0")/.."
results=${TED4_RESULTS:-bench}
table=${TED4_TABLE:-bench/stability.txt}
. bench/page.sh
wanted_runs bench/stability.sh "$@"
write_page "$results/stability.md" "$results/stability.csv" "$results/lab" "report/rows report/words report/svg report/axes stability/rules stability/notes
    stability/marks stability/tables stability/page" -v notes="${TED4_NOTES:-bench/stability-notes.md}"
