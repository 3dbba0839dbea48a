#!/bin/sh
# Runs test programs and prints each one's name, its failures, and totals. The exit status is 0 if
# all passed. cmocka's own report goes to a log beside the program and is shown only if something
# failed or was skipped.
# With these settings, numbers and ranges of letters are read as the programs write them, and
# options may follow arguments.
export LC_ALL=C
unset POSIXLY_CORRECT

# suits FOLDER: whether tests can make programs below it and run them, and its path has no space.
suits() {
    case $1 in *[[:space:]]*) return 1 ;; esac
    trial=$(mktemp "$1/ted4-run-XXXXXX") || return 1
    printf '#!/bin/sh\nexit 0\n' >"$trial"
    chmod +x "$trial"
    "$trial"
    can=$?
    rm -f "$trial"
    return $can
}
asked=${TMPDIR:-/tmp}
for base in "$asked" "${TED4_BUILD:-$(pwd)}" /tmp; do suits "$base" 2>/dev/null && break; done
own=$(mktemp -d "$base/ted4-run-XXXXXX") || exit 1
trap 'rm -rf "$own"' EXIT
trap 'exit 130' INT
trap 'exit 143' TERM
if [ "$base" != "$asked" ]; then
    echo "temporary files are made in $own: $asked runs no programs, or has a space"
    export TMPDIR="$own"
fi
# Commands that programs are given are split at spaces, and make allows no spaces in names.
case ${TED4_BUILD:-} in
*[[:space:]]*) ln -s "$TED4_BUILD" "$own/build" && export TED4_BUILD="$own/build" ;;
esac

# counts LOG: prints how many tests passed, failed and were skipped, how many of these without a
# line before that says why, and how many groups of tests did not come to their end. cmocka prints
# what failed or was skipped once more at the end.
counts() {
    awk '
        { name = $0; sub(/^\[[^]]*\] /, "", name); sub(/[: ].*/, "", name) }
        /^\[==========\].*Running [0-9]+ test\(s\)/ { open++ }
        /^\[==========\].* test\(s\) run/ { open-- }
        tolower($0) ~ /^skip/ { reason = 1 }
        /^\[       OK \]/ { ok++; reason = 0 }
        /^\[  FAILED  \] [^0-9]/ { if (!failed[name]++) bad++; reason = 0 }
        /^\[  SKIPPED \] [^0-9]/ {
            if (!skipped[name]++) { skip++; silent += !reason }
            reason = 0
        }
        END { print ok + 0, bad + 0, skip + 0, silent + 0, open + 0 }' "$1"
}

passed=0 failed=0 skipped=0
for t in "$@"; do
    printf '%s ... ' "$(basename "$t")"
    CMOCKA_MESSAGE_OUTPUT=STDOUT "$t" >"$t.log" 2>&1
    status=$?
    read -r ok bad skip silent open <<END
$(counts "$t.log")
END
    if [ $status -ne 0 ] && [ "$bad" -eq 0 ]; then bad=1; fi
    if [ "$bad" -ne 0 ]; then
        echo "FAILED ($bad)"
        cat "$t.log"
    elif [ "$open" -ne 0 ]; then
        echo "FAILED: ended before its last test"
        cat "$t.log"
        bad=1
    elif [ "$ok" -eq 0 ] && [ "$skip" -eq 0 ]; then
        echo "FAILED: ran nothing"
        bad=1
    else
        if [ "$skip" -eq 0 ]; then echo "$ok passed"; else echo "$ok passed, $skip skipped"; fi
        grep -i '^skip' "$t.log"
        [ "$silent" -eq 0 ] || echo "skipped: no reason given"
    fi
    passed=$((passed + ok)) failed=$((failed + bad)) skipped=$((skipped + skip))
done
echo "$passed passed, $failed failed, $skipped skipped"
[ $failed -eq 0 ] && [ $passed -gt 0 ]
