# speak.sh - what a test in shell says, as cmocka programs do. Sourced by tests/*/test_*.sh from the
# project's root; their last line is `exit $bad`. $out: a folder of the test's own, gone when it
# ends.
# SPDX-License-Identifier: BSD-2-Clause
export LC_ALL=C # awk's numbers, and [a-z]
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
bad=0

ok()   { echo "[       OK ] $1"; }
fail() { echo "[  FAILED  ] $1: $2"; bad=1; }
skip() { echo "skipped: $2"; echo "[  SKIPPED ] $1"; }

# need TEST PROGRAM...: of $TED4_BUILD, or python3. Without python3, or without a build, the whole
# test is skipped. A build that lacks a program fails: nobody misses a test that skips itself.
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

# expect NAME STATUS TEXT COMMAND...: it ends with that status and says that text.
expect() {
    name=$1 wanted=$2 text=$3; shift 3
    "$@" >"$out/said" 2>&1
    status=$?
    if [ $status -eq "$wanted" ] &&
        grep -qF -e "$text" "$out/said"; then ok "$name";
    else fail "$name" "status $status: $(cat "$out/said")"; fi
}

# check NAME FILE PATTERN...: each fixed string stands in the file.
check() {
    name=$1 file=$2; shift 2
    for p; do
        grep -qF -e "$p" "$file" ||
            { fail "$name" "no \"$p\" in:"; grep -F -e "${p%%[|:]*}" "$file" | head -n 5; return; }
    done
    ok "$name"
}
