#!/bin/sh
# machines.sh BUILD - runs the test programs of a build folder once with the kernels of each level
# (ref-decoder/base/level.h), or of those that TEST_LEVELS names. Levels that this machine lacks are
# reported as left out. Prints a line as each level ends, and stores its output in
# BUILD/machines-LEVEL.log. The exit status is 0 if there was a level, and all tests passed.
# SPDX-License-Identifier: BSD-2-Clause
build=$1
has=$(TED4_KERNEL=none "$build/ted4dec" - 2>&1 </dev/null | sed -n 's/.*this machine has plain//p')
case $has in *v1*) all="v1 v3 v4" ;; *) all=$has ;; esac
programs=$(ls tests/*/test_*.c tests/*/test_*.sh | sed "s|^|$build/|;s|\.[a-z]*$||")
bad=0 levels=

for level in ${TEST_LEVELS:-$all}; do
    case " $has " in
    *" $level "*) levels="$levels $level" ;;
    *) echo "left out: $level; this machine has$has" ;;
    esac
done
[ -n "$levels" ] || { echo "machines.sh: no level is left"; exit 1; }
for level in $levels; do
    log=$build/machines-$level.log
    began=$(date +%s)
    TED4_KERNEL=$level TED4_BUILD=$(cd "$build" && pwd) sh tests/run.sh $programs >"$log" 2>&1 ||
        bad=1
    grep FAILED "$log" | grep -v '^\['
    printf '%-12s %-5s %s, %d s, %s\n' "$build" "$level" "$(tail -n 1 "$log")" \
        $(($(date +%s) - began)) "$log"
done
exit $bad
