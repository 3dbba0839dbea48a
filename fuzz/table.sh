#!/bin/sh
# table.sh BUILD - writes the sums of the rows in fuzz/runs.csv between the marks of fuzz/README.md.
# BUILD: the folder of a build with the present sources (key.sh). run.sh calls it at its end. From
# the project root: fuzz/table.sh build-fuzz-asan
# SPDX-License-Identifier: BSD-2-Clause
set -eu
LC_ALL=C; export LC_ALL
build=$1
new=fuzz/README.md.$$
trap 'rm -f "$new" "$new.keys"' EXIT
# The present key of each harness, one per line.
for h in $(sed -n 's/,.*//p' fuzz/runs.csv | sed 1d | sort -u); do
    echo "$h $(fuzz/key.sh "$h" "$build")"
done >"$new.keys"
table() {
    printf '| harness | build | hours, present sources | executions | finds | memory at most '
    echo '| hours, all sources | executions | finds |'
    echo '|---|---|---|---|---|---|---|---|---|'
    awk -F, -v keys="$new.keys" '
        BEGIN {
            while ((getline line < keys) > 0) {
                split(line, word, " ")
                key[word[1]] = word[2]
            }
        }
        FNR > 1 {
            h = $1 "` | " $2
            s[h] += $4; n[h] += $5; f[h] += $6
            if ($3 != key[$1]) next
            now_s[h] += $4; now_n[h] += $5; now_f[h] += $6
            if ($9 > peak[h]) peak[h] = $9
        }
        END {
            for (h in s)
                printf "| `%s | %.2f | %d | %d | %d MB | %.2f | %d | %d |\n", h, \
                    now_s[h] / 3600, now_n[h], now_f[h], peak[h], s[h] / 3600, n[h], f[h]
        }' fuzz/runs.csv | sort
}
awk '/^<!-- runs -->$/ { print; exit } { print }' fuzz/README.md >"$new"
table >>"$new"
awk '/^<!-- end of runs -->$/ { on = 1 } on { print }' fuzz/README.md >>"$new"
mv "$new" fuzz/README.md
