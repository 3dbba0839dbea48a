#!/bin/sh
# capacity_page.sh - writes bench/capacity.md and the SVG charts in bench/capacity from the rows of bench/capacity.csv that are there. Needs awk alone. The same
# rows give the same bytes.
# Usage, from anywhere:  bench/capacity_page.sh [STATES]
#     STATES   a file of lines "STATE TAG", which capacity.sh --list prints; asked of that without it
# Environment: TED4_RESULTS (bench: where capacity.csv lies and the page and charts go), TED4_TABLE (bench/capacity.txt).
# SPDX-License-Identifier: BSD-2-Clause
set -eu
cd "$(dirname "$0")/.."
results=${TED4_RESULTS:-bench}
table=${TED4_TABLE:-bench/capacity.txt}
. bench/page.sh
wanted_runs bench/capacity.sh "$@"
write_page "$results/capacity.md" "$results/capacity.csv" "$results/capacity" "report/rows report/words report/svg report/axes report/plot capacity/cost
    capacity/bars capacity/page"
