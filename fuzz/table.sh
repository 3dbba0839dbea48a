#!/bin/sh
# table.sh - what the rows of fuzz/runs.csv add up to, between the marks of fuzz/README.md. run.sh calls it at its end. From the project root: fuzz/table.sh
# SPDX-License-Identifier: BSD-2-Clause
set -eu
LC_ALL=C; export LC_ALL
new=fuzz/README.md.$$
trap 'rm -f "$new"' EXIT
# A harness's latest key is that of its last row.
table() {
    echo '| harness | build | hours, latest sources | executions | finds | memory at most | hours, all sources | executions | finds |'
    echo '|---|---|---|---|---|---|---|---|---|'
    awk -F, 'NR > 1 {
            h = $1 "` | " $2
            if (key[h] != $3) { key[h] = $3; now_s[h] = now_n[h] = now_f[h] = peak[h] = 0 }
            now_s[h] += $4; now_n[h] += $5; now_f[h] += $6; s[h] += $4; n[h] += $5; f[h] += $6
            if ($9 > peak[h]) peak[h] = $9
        }
        END {
            for (h in s)
                printf "| `%s | %.2f | %d | %d | %d MB | %.2f | %d | %d |\n", h, now_s[h] / 3600, now_n[h], now_f[h], peak[h], s[h] / 3600, n[h], f[h]
        }' fuzz/runs.csv | sort
}
awk '/^<!-- runs -->$/ { print; exit } { print }' fuzz/README.md >"$new"
table >>"$new"
awk '/^<!-- end of runs -->$/ { on = 1 } on { print }' fuzz/README.md >>"$new"
mv "$new" fuzz/README.md
