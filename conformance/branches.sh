#!/bin/sh
# Prints the branch outcomes of norm/ and read/ as gcov counts them, both of every condition, as a
# table: file, function, line, gcov's number of the outcome on that line, 1 if it was taken, the
# text of the line. Needs a build with --coverage whose programs have run. branches.awk reads the
# table.
#     conformance/branches.sh BUILD >TABLE
# SPDX-License-Identifier: BSD-2-Clause
export LC_ALL=C
build=$1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
for o in "$build"/ref-decoder/norm/*.o "$build"/ref-decoder/read/*.o; do
    gcov -t -b -c -o "$(dirname "$o")" "$o" 2>/dev/null
done >"$work/all"
awk '
    /^ *-: *0:Source:/ {
        file = $0
        sub(/.*Source:/, "", file)
        wanted = file ~ /^ref-decoder\/(norm|read)\//
        next
    }
    !wanted { next }
    /^function / { function_name = $2; next }
    /^ *[-#=0-9*]+: *[0-9]+:/ {
        split($0, f, ":")
        line = f[2] + 0
        text = $0
        sub(/^[^:]*:[^:]*:/, "", text)
        gsub(/^[ \t]+|[ \t]+$/, "", text)
        n = 0
        next
    }
    /^branch/ {
        key = file "\t" function_name "\t" line "\t" n++
        said[key] = text
        taken[key] += $3 != "executed" && $4 + 0 > 0
    }
    END { for (key in said) print key "\t" (taken[key] > 0) "\t" said[key] }' "$work/all" |
    sort -t "$(printf '\t')" -k 1,1 -k 3,3n -k 4,4n
