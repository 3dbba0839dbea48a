#!/bin/sh
# test_run.sh - tests/run.sh reports for each program how many tests passed, and how many were
# skipped if any were; a program that fails, crashes or runs no test is a failure. Prints lines as a
# cmocka program does; run by `make test` from the project's root.
# SPDX-License-Identifier: BSD-2-Clause
set -u
. tests/support/speak.sh
# program NAME STATUS LINE...
program() { file=$out/$1 status=$2; shift 2; { echo '#!/bin/sh'; for l; do echo "echo '$l'"; done;
    echo "exit $status"; } >"$file"; chmod +x "$file"; }

program good 0 '[       OK ] a' '[       OK ] b'
program half 0 '[       OK ] a' 'skipped: no scene' '[  SKIPPED ] b'
program wrong 1 '[       OK ] a' '[  FAILED  ] b: why'
program broken 139
program empty 0
runs() { name=$1 status=$2 text=$3; shift 3; expect "$name" "$status" "$text" sh tests/run.sh \
    "$@"; }
runs passes 0 '2 passed, 0 failed, 0 skipped' "$out/good"
if [ "$(head -n 1 "$out/said")" = 'good ... 2 passed' ]; then ok none_skipped;
else fail none_skipped "$(cat "$out/said")"; fi
runs skips 0 'half ... 1 passed, 1 skipped' "$out/half"
runs says_why_skipped 0 'skipped: no scene' "$out/half"
runs fails 1 '3 passed, 1 failed, 0 skipped' "$out/good" "$out/wrong"
runs shows_failures 1 '[  FAILED  ] b: why' "$out/wrong"
runs breaks_off 1 'broken ... FAILED (1)' "$out/broken"
runs nothing 1 'empty ... FAILED: ran nothing' "$out/empty"
exit $bad
