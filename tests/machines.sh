#!/bin/sh
# machines.sh BUILD... - the test programs of each build folder, once with the kernels of each level that this machine has
# (ref-decoder/base/level.h); TEST_LEVELS names some of them. A line for each, a table at the end; what each said is kept in
# BUILD/machines-LEVEL.log. Exit status: did all pass?
# SPDX-License-Identifier: BSD-2-Clause
has=$(TED4_KERNEL=none "$1/ted4dec" - 2>&1 </dev/null | sed -n 's/.*this machine has plain//p')
levels=${TEST_LEVELS:-$has}
table=$(mktemp)
trap 'rm -f "$table"' EXIT
bad=0

[ -n "$levels" ] || { echo "machines.sh: $1/ted4dec names no level"; exit 1; }
case $has in
*v1*)
    for level in v1 v3 v4; do
        case " $has " in *" $level "*) ;; *) echo "left out: $level, which this machine has not" | tee -a "$table" ;; esac
    done ;;
esac
for build; do
    for level in $levels; do
        case " $has " in *" $level "*) ;; *) continue ;; esac
        log=$build/machines-$level.log
        began=$(date +%s)
        programs=$(ls tests/test_*.c tests/test_*.sh | sed "s|^|$build/|;s|\.[a-z]*$||")
        TED4_KERNEL=$level TED4_BUILD=$(cd "$build" && pwd) sh tests/run.sh $programs >"$log" 2>&1 || bad=1
        grep FAILED "$log" | grep -v '^\['
        line=$(printf '%-12s %-5s %s, %d s, %s' "$build" "$level" "$(tail -n 1 "$log")" $(($(date +%s) - began)) "$log")
        echo "$line" | tee -a "$table"
    done
done
echo
cat "$table"
exit $bad
