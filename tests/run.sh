#!/bin/sh
# Runs test programs; prints each one's name, its failures, and totals. Exit status: did all pass?
# cmocka's own report goes to a log beside the program, shown only when it failed or skipped
# something.
passed=0 failed=0 skipped=0
for t in "$@"; do
    printf '%s ... ' "$(basename "$t")"
    CMOCKA_MESSAGE_OUTPUT=STDOUT "$t" >"$t.log" 2>&1
    status=$?
    ok=$(grep -c '^\[       OK \]' "$t.log")
    skip=$(grep -c '^\[  SKIPPED \] [^0-9]' "$t.log")
    bad=$(grep -c '^\[  FAILED  \] [^0-9]' "$t.log")
    if [ $status -ne 0 ] && [ "$bad" -eq 0 ]; then bad=1; fi
    if [ $status -ne 0 ]; then
        echo "FAILED ($bad)"
        cat "$t.log"
    elif [ "$ok" -eq 0 ] && [ "$skip" -eq 0 ]; then
        echo "FAILED: ran nothing"
        bad=1
    else
        if [ "$skip" -eq 0 ]; then echo "$ok passed"; else echo "$ok passed, $skip skipped"; fi
        grep -i '^skip' "$t.log"
    fi
    passed=$((passed + ok)) failed=$((failed + bad)) skipped=$((skipped + skip))
done
echo "$passed passed, $failed failed, $skipped skipped"
[ $failed -eq 0 ] && [ $passed -gt 0 ]
