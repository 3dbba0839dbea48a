#!/bin/sh
# coverage.sh - how much of the code that each harness tests is reached by its seeds and
# regressions: fuzz/coverage.sh PROGRAM, where PROGRAM is main.c built by clang for source-based
# coverage, of version LLVM_VERSION (14). Writes a table between the marks in fuzz/README.md. The
# exit status is 1 if a harness is below 80 % of lines.
# SPDX-License-Identifier: BSD-2-Clause
set -eu
program=$1 llvm=${LLVM_VERSION:-14}
work=$(dirname "$program")/coverage
mkdir -p "$work"
table=$work/table.md
printf '| harness | covers | lines | reached |\n|---|---|---|---|\n' >"$table"
# Joins the lines of an entry, whose strings may continue on further lines.
sed -n '/^FUZZ(/{
    :more
    /)$/!{
        N
        b more
    }
    s/"\n *"//g
    s/,\n */, /
    s/^FUZZ(\([a-z_0-9]*\), \([a-z_0-9]*\), "\(.*\)")/\1 \2 \3/p
}' fuzz/list.def | while read -r name seeds covers; do
    old=fuzz/regressions/$name
    [ -d "$old" ] || old=
    LLVM_PROFILE_FILE=$work/$name.raw "$program" "$name" "fuzz/corpus/$seeds" $old >&2
    "llvm-profdata-$llvm" merge -sparse "$work/$name.raw" -o "$work/$name.data"
    # shellcheck disable=SC2086 # $covers holds patterns
    "llvm-cov-$llvm" report "$program" -instr-profile="$work/$name.data" $covers >"$work/$name.txt"
    awk -v name="$name" -v covers="$covers" '$1 == "TOTAL" { sub(/%/, "", $10)
        printf "| `%s` | %s | %d | %.1f %% |\n", name, covers, $8, $10
    }' "$work/$name.txt" >>"$table"
done
awk -v table="$table" '
    /^<!-- coverage -->/ { print; while ((getline line < table) > 0) print line; skip = 1 }
    /^<!-- end -->/ { skip = 0 }
    !skip' fuzz/README.md >"$work/README.md"
cat "$work/README.md" >fuzz/README.md
cat "$table"
awk -F'|' 'NR > 2 && $5 + 0 < 80 { print "below 80 %:" $2; bad = 1 } END { exit bad }' "$table" >&2
