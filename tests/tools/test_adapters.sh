#!/bin/sh
# test_adapters.sh - conformance/adapters: our library behind adapter.c, and a decoder that prints
# lines behind line.py, pass vectors of each kind; lines that are not a valid answer do not count as
# one. Prints lines as a cmocka program does; run by `make test` from the project's root.
# SPDX-License-Identifier: BSD-2-Clause
set -u
. tests/support/speak.sh
need adapters python3 ted4conf ted4dec adapter
export PYTHONDONTWRITEBYTECODE=1 TED4DEC="$TED4_BUILD/ted4dec"
# run NAME WANTED-STATUS WANTED-TEXT LIST DECODER
run() { expect "$1" "$2" "$3" "$TED4_BUILD/ted4conf" run -q --memory 0 -t 60 -l "conformance/$4" \
    -d "$5"; }

line='python3 conformance/adapters/line.py python3 conformance/tests/line_decoder.py'
run library 0 ' 8 passed, 0 failed, 0 without answer, 0 missing, 0 declined, 0 not run: conforms' \
    lists/few.txt "$TED4_BUILD/adapter"
run library_queries 0 ' 4 passed, 0 failed, 0 without answer' tests/class-t.txt \
    "$TED4_BUILD/adapter"
run lines 0 ' 7 passed, 0 failed, 0 without answer, 0 missing, 1 declined, 0 not run: conforms' \
    lists/few.txt "$line good"
run lines_queries 0 ' 4 passed, 0 failed, 0 without answer' tests/class-t.txt "$line good"
run no_hex 1 ' 3 passed, 0 failed, 4 without answer' lists/few.txt "$line no-hex"
run two_verdicts 1 ' 3 passed, 0 failed, 4 without answer' lists/few.txt "$line two-verdicts"
run no_end 1 ' 0 passed, 0 failed, 8 without answer' lists/few.txt "$line no-end"
expect unread 0 '"error":"io.read"' "$TED4_BUILD/adapter" --ted4-run "$out" --tiers T0
exit $bad
