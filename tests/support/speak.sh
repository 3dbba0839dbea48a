# speak.sh - lets a test in shell print lines as a cmocka program does. Sourced by tests/*/test_*.sh
# from the project's root; their last line is `exit $bad`. $out: a folder of the test's own, removed
# when it ends.
# SPDX-License-Identifier: BSD-2-Clause
export LC_ALL=C # for awk's numbers, and [a-z]
out=$(mktemp -d) || exit 1
trap 'rm -rf "$out"' EXIT
bad=0

ok()   { echo "[       OK ] $1"; }
fail() { echo "[  FAILED  ] $1: $2"; bad=1; }
skip() { echo "skipped: $2"; echo "[  SKIPPED ] $1"; }

# need TEST PROGRAM...: programs of $TED4_BUILD, or python3. Without python3, or without a build,
# the whole test is skipped. If the build lacks a program, the test fails: a skip would go
# unnoticed.
need() {
    whole=$1; shift
    for program; do
        if [ "$program" = python3 ]; then
            command -v python3 >/dev/null || { skip "$whole" "there is no python3"; exit 0; }
        elif [ -z "${TED4_BUILD:-}" ]; then
            skip "$whole" "TED4_BUILD is not set"; exit 0
        elif [ ! -x "$TED4_BUILD/$program" ]; then
            fail "$whole" "$TED4_BUILD has no $program"; exit 1
        fi
    done
}

# expect NAME STATUS TEXT COMMAND...: the command ends with that status and prints that text.
expect() {
    name=$1 wanted=$2 text=$3; shift 3
    "$@" >"$out/said" 2>&1
    status=$?
    if [ $status -eq "$wanted" ] &&
        grep -qF -e "$text" "$out/said"; then ok "$name";
    else fail "$name" "status $status: $(cat "$out/said")"; fi
}

# check NAME FILE PATTERN...: the file contains each fixed string.
check() {
    name=$1 file=$2; shift 2
    for p; do
        grep -qF -e "$p" "$file" ||
            { fail "$name" "no \"$p\" in:"; grep -F -e "${p%%[|:]*}" "$file" | head -n 5; return; }
    done
    ok "$name"
}
