#!/bin/sh
# test_branches.sh - conformance/branches.awk on small tables: which branches count as taken, which
# are listed separately, and which mistakes in the list it finds. Prints lines as a cmocka program
# does; run by `make test` from the project's root.
# SPDX-License-Identifier: BSD-2-Clause
set -u
. tests/support/speak.sh
# table FILE LINE-OF-WORDS...: file function line outcome taken text
table() { to=$out/$1; shift; for row; do echo "$row" | tr ' ' '\t' | tr _ ' '; done >"$to"; }
judge() { awk -f conformance/branches.awk "$out/list" "$out/suite" "$out/tests"; }
list() { printf '# a comment\n\n' >"$out/list"; for row; do echo "$row" >>"$out/list"; done; }

# 200 outcomes of one function, all taken, and the given lines.
suite() {
    awk 'BEGIN { for (i = 0; i < 200; i++) print "a.c\tmany\t" i "\t0\t1\tif (" i ")" }' \
        >"$out/most"
    table suite "$@"
    cat "$out/most" >>"$out/suite"
}
table tests 'a.c f 7 1 1 if_(p)' 'a.c f 9 1 0 if_(q)'
list
suite 'a.c f 7 0 1 if_(p)' 'a.c f 7 1 1 if_(p)'
expect all_taken 0 '202 of 202 branch outcomes taken: 100.00 %' judge
suite 'a.c f 7 0 1 if_(p)' 'a.c f 7 1 0 if_(p)'
expect not_listed 0 'not taken: a.c:7: f: if (p) | 1' judge
expect not_listed_counts 0 \
    '201 of 202 branch outcomes taken: 99.50 %; not taken: 0 of other machines, 0 of larger files, 0 never, 1 others' judge
list 'a.c: f: if (p) | allocation 1 | memory'
expect apart 0 '201 of 201 branch outcomes taken: 100.00 %; not taken: 0 of other machines, 0 of larger files, 0 never, 0 others; apart, for tests: 1 of failing' judge
list 'a.c: f: if (p) | size 1 | large'
expect other_reasons_count 0 \
    '201 of 202 branch outcomes taken: 99.50 %; not taken: 0 of other machines, 1 of larger files' \
    judge
suite 'a.c f 9 0 1 if_(q)' 'a.c f 9 1 0 if_(q)'
list 'a.c: f: if (q) | writer 1 | readers do not'
table tests 'a.c f 9 1 1 if_(q)'
expect of_writing 0 '201 of 201 branch outcomes taken: 100.00 %; not taken: 0 of other machines, 0 of larger files, 0 never, 0 others; apart, for tests: 0 of failing allocations, 0 of mistakes of callers, 1 of writing' judge
table tests 'a.c f 7 1 1 if_(p)' 'a.c f 9 1 0 if_(q)'
list 'a.c: f: if (q) | caller 1 | a mistake'
expect no_test_takes 1 'no test takes: a.c: f: if (q) | 1' judge
list 'a.c: f: if (q) | writer 1 | readers do not'
expect no_test_writes 1 'no test takes: a.c: f: if (q) | 1' judge
suite 'a.c f 7 0 0 if_(p)' 'a.c f 7 1 0 if_(p)' 'a.c f 8 0 0 if_(r)'
list
expect below_99 1 '200 of 203 branch outcomes taken: 98.52 %' judge

# Mistakes of the list.
suite 'a.c f 7 0 1 if_(p)' 'a.c f 7 1 1 if_(p)'
list 'a.c: f: if (p) | allocation 1 | memory'
expect taken_after_all 1 'excluded, but the vectors take it: a.c: f: if (p) | 1' judge
list 'a.c: g: if (p) | allocation 1 | memory'
expect another_function 1 'excluded, but not there: a.c: g: if (p) | 1' judge
list 'a.c: f: if (p) | allocation 2 | memory'
expect another_outcome 1 'excluded, but not there: a.c: f: if (p) | 2' judge
suite 'a.c f 7 1 0 if_(p)' 'a.c f 8 1 0 if_(p)'
list 'a.c: f: if (p) | allocation 1 | memory'
expect stands_there_twice 1 'stands there twice: a.c: f: if (p)' judge
list 'a.c: f: if (p) | encoder 1 | no such reason'
expect no_such_reason 1 'not in the form of an entry: a.c: f: if (p) | encoder 1' judge
exit $bad
