#!/bin/sh
# run_one.sh - one harness for run.sh, which passes csv, build, kind, total and slice in the
# environment.
# SPDX-License-Identifier: BSD-2-Clause
set -eu
name=$1
# shellcheck disable=SC2154 # from the environment
log=$build/$name.log own=$build/corpus/$name scratch=$build/tmp/$name

key=$(fuzz/key.sh "$name" "$build")
seeds=$(sed -n "s/^FUZZ($name, \([a-z_0-9]*\),.*/\1/p" fuzz/list.def)
case $seeds in
knobs | ted4 | recon) dictionary=fuzz/ted4.dict ;;
*) dictionary=fuzz/scene.dict ;;
esac

finds() {
    find "$build/found" -name "$name-*" | wc -l
}

# Seconds so far, from the rows of this harness with these sources.
had() {
    awk -F, -v h="$name" -v k="$kind" -v key="$key" '
        $1 == h && $2 == k && $3 == key { s += $4 }
        END { print s + 0 }' "$csv"
}

# What only a busy machine made slow is no find: it takes less than ten seconds of a processor.
drop_starved() {
    for slow in "$build/found/$name"-slow-unit-* "$build/found/$name"-timeout-*; do
        [ ! -e "$slow" ] || ! (ulimit -t 10 && "$build/fuzz/fuzz_$name" "$slow") >>"$log" 2>&1 ||
            rm "$slow"
    done
}

# Earlier finds are tested again, too.
found=
[ ! -d "fuzz/regressions/$name" ] || found=fuzz/regressions/$name

mkdir -p "$own"
while left=$((total - $(had))) && [ "$left" -gt 0 ]; do
    now=$((left < slice ? left : slice))
    before=$(finds) began=$(date +%s)
    mkdir -p "$scratch"
    # shellcheck disable=SC2086 # none or one
    TMPDIR=$scratch "$build/fuzz/fuzz_$name" -max_total_time="$now" -max_len=4096 \
        -dict=$dictionary -timeout=100 -rss_limit_mb=2500 -malloc_limit_mb=2500 \
        -print_final_stats=1 -artifact_prefix="$build/found/$name-" \
        "$own" "fuzz/corpus/$seeds" $found >"$log" 2>&1 || :
    ran=$(($(date +%s) - began))        # less than a slice after a find or a signal
    [ "$ran" -lt "$now" ] || ran=$now
    rm -rf "$scratch"                   # libFuzzer ends without the handlers that would
    drop_starved
    after=$(finds)
    grep -q '^stat::' "$log" || { echo "$name: did not run, see $log" >&2; exit 1; }
    awk -v row="$name,$kind,$key,$ran" -v finds=$((after - before)) \
        -v inputs="$(find "$own" -type f | wc -l)" '
        / cov: / { for (i = 1; i < NF; i++) if ($i == "cov:") edges = $(i + 1) }
        /^stat::number_of_executed_units/ { n = $2 }
        /^stat::peak_rss_mb/ { peak = $2 }
        END { print row "," n + 0 "," finds "," edges + 0 "," inputs "," peak + 0 }' "$log" >>"$csv"
    tail -n 1 "$csv"
    [ "$after" -eq "$before" ] || { echo "$name: a find, see $log" >&2; exit 1; }
done
