#!/bin/sh
# test_run.sh - tests/run.sh reports for each program how many tests passed, and how many were
# skipped if any were; a program that fails, crashes or runs no test is a failure. Programs have the
# locale C, and temporary files where they can run what they make. Prints lines as a cmocka program
# does; run by `make test` from the project's root.
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
# cmocka prints what failed or was skipped once more at the end.
program cmocka 1 '[==========] Running 3 test(s).' '[       OK ] a' 'skipped: no scene' \
    '[  SKIPPED ] b' '[  FAILED  ] c' '[==========] 3 test(s) run.' '[  PASSED  ] 1 test(s).' \
    '[  SKIPPED ] 1 test(s), listed below:' '[  SKIPPED ] b' \
    '[  FAILED  ] 1 test(s), listed below:' '[  FAILED  ] c'
program silent 0 '[  SKIPPED ] a' 'skipped: no scene' '[  SKIPPED ] b' '[  SKIPPED ] b'
program early 0 '[==========] Running 2 test(s).' '[       OK ] a'
program whole 0 '[==========] Running 1 test(s).' '[       OK ] a' '[==========] 1 test(s) run.' \
    '[==========] tests: Running 1 test(s).' '[       OK ] b' \
    '[==========] tests: 1 test(s) run.'
program polite 0 '[       OK ] a' '[  FAILED  ] b: why'
program empty 0
runs() { name=$1 status=$2 text=$3; shift 3; expect "$name" "$status" "$text" sh tests/run.sh \
    "$@"; }
runs passes 0 '2 passed, 0 failed, 0 skipped' "$out/good"
if [ "$(head -n 1 "$out/said")" = 'good ... 2 passed' ]; then ok none_skipped;
else fail none_skipped "$(cat "$out/said")"; fi
runs skips 0 'half ... 1 passed, 1 skipped' "$out/half"
runs says_why_skipped 0 'skipped: no scene' "$out/half"
! grep -q 'no reason' "$out/said" || fail says_why_skipped "$(cat "$out/said")"
runs fails 1 '3 passed, 1 failed, 0 skipped' "$out/good" "$out/wrong"
runs shows_failures 1 '[  FAILED  ] b: why' "$out/wrong"
runs breaks_off 1 'broken ... FAILED (1)' "$out/broken"
runs says_silent_skip 0 'skipped: no reason given' "$out/good" "$out/silent"
runs counts_once 1 '1 passed, 1 failed, 1 skipped' "$out/cmocka"
runs counts_skips_once 0 '1 passed, 0 failed, 3 skipped' "$out/half" "$out/silent"
runs ends_early 1 'early ... FAILED: ended before its last test' "$out/early"
runs whole 0 '2 passed, 0 failed, 0 skipped' "$out/whole"
runs fails_with_status_0 1 'polite ... FAILED (1)' "$out/polite"
runs nothing 1 'empty ... FAILED: ran nothing' "$out/empty"

# The environment of programs.
cat >"$out/finds" <<END
#!/bin/sh
printf '%s\n' "\$LC_ALL" "\${POSIXLY_CORRECT-unset}" "\$TMPDIR" >"$out/found"
ls "\${TED4_BUILD:-/}" >"$out/listed"
echo "\${TED4_BUILD:-}" >"$out/built"
echo '[       OK ] finds'
END
chmod +x "$out/finds"
mkdir "$out/a b" "$out/build"
runs finds 0 '1 passed, 0 failed' "$out/finds"
same() { if [ "$2" = "$3" ]; then ok "$1"; else fail "$1" "$2, not $3"; fi; }
# place NAME TMPDIR: programs get another folder, below the build, which is removed afterwards.
place() {
    expect "$1" 0 'temporary files are made in ' env LC_ALL=C.UTF-8 POSIXLY_CORRECT=1 TMPDIR="$2" \
        TED4_BUILD="$out/build" sh tests/run.sh "$out/finds"
    same "$1_found" "$(sed 's/-.*//' "$out/found" | tr '\n' ' ')" "C unset $out/build/ted4 "
    same "$1_removed" "$(ls "$out/build")" ''
}
place space "$out/a b"
place absent "$out/none"
# A build whose path has a space gets a path without one.
mkdir "$out/a build"
: >"$out/a build/program"
expect build_space 0 '1 passed' env TED4_BUILD="$out/a build" sh tests/run.sh "$out/finds"
same build_listed "$(cat "$out/listed") $(wc -w <"$out/built")" 'program 1'
# A folder in which no program can run: a file system of its own, if this user can mount one.
mkdir "$out/still"
if unshare -rm mount -t tmpfs -o noexec none "$out/still" 2>/dev/null; then
    expect noexec 0 'temporary files are made in ' env TMPDIR="$out/still" TED4_BUILD="$out/build" \
        unshare -rm sh -c 'mount -t tmpfs -o noexec none "$TMPDIR" && sh tests/run.sh "$1"' sh \
        "$out/finds"
else
    skip noexec "there can be no file system of its own here"
fi
exit $bad
