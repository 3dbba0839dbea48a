#!/bin/sh
# run.sh - runs the libFuzzer programs, one slice of time each, and adds one row per slice to
# fuzz/runs.csv, until every harness has had its seconds with the present sources. If it is killed,
# it loses one slice; if it is started again, it continues. From the project root:
#     fuzz/run.sh [-t SECONDS] [-s SLICE] [-j JOBS] [-k asan|msan] [NAME...]
# New inputs are in build-fuzz-KIND/corpus/NAME, those that break a claim in
# build-fuzz-KIND/found/NAME-*. A harness with a find stops; then this script ends with an error. -j
# harnesses run at a time, each in one process (run_one.sh).
# SPDX-License-Identifier: BSD-2-Clause
set -eu
total=7200 slice=600 jobs=1 kind=asan
while getopts t:s:j:k: option; do
    case $option in
    t) total=$OPTARG ;;
    s) slice=$OPTARG ;;
    j) jobs=$OPTARG ;;
    k) kind=$OPTARG ;;
    *) exit 3 ;;
    esac
done
shift $((OPTIND - 1))
csv=${FUZZ_CSV:-fuzz/runs.csv}
build=build-fuzz-$kind
make -s fuzz-build FUZZ_KIND="$kind"
mkdir -p "$build/found"
[ -s "$csv" ] || echo 'harness,kind,key,seconds,executions,finds,edges,inputs,peak_mb' >"$csv"
export csv build kind total slice
if [ $# -eq 0 ]; then
    for program in "$build"/fuzz/fuzz_*; do
        [ -x "$program" ] && set -- "$@" "${program##*/fuzz_}"
    done
fi
bad=0
printf '%s\n' "$@" | xargs -P "$jobs" -I{} fuzz/run_one.sh {} || bad=1
[ "$csv" != fuzz/runs.csv ] || fuzz/table.sh "$build"
exit $bad
