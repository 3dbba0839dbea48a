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
results=${TED4_RESULTS:-bench}
table=${TED4_TABLE:-bench/sweep.txt}
pages=${TED4_PAGES:-bench}
. bench/page.sh
wanted_runs bench/sweep.sh "$@"
write_page "$results/report.md" "$results/sweep.csv" "$results/charts" "report/rows report/words report/curves report/compare report/svg report/axes report/plot
    report/dots report/stacks report/rate report/variants report/singles report/speed report/bytes report/lives report/estimate report/kept report/precision
    report/seeds report/seeded report/recipe report/logs report/page" -v results="$results" -v pages="$pages" -v notes="$pages/report-notes.md"
