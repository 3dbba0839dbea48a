#!/bin/sh
# slurm.sh - makes the missing and stale rows of a table of runs by job arrays of Slurm, on machines
# that share this folder. bench/cluster.md tells how.
# Usage, from anywhere:  bench/cluster/slurm.sh TABLE [PATTERN...]
#                             [--missing] [--tasks N] [--at-once N] [--wait]
#                             [-- OPTION_OF_SBATCH...]
#     TABLE        sweep, stability, capacity, zoo, bd_rate or held_out
#     PATTERN..., --missing, and the environment    as bench/sweep.sh, bench/stability.sh, ... take
#                                                   them
#     --tasks N    at most N tasks of an array, each of which makes every N-th run; without it as
#                  many as there are runs, or as MaxArraySize allows
#     --at-once N  at most N tasks at a time
#     --wait       does not return before the jobs have ended
# OPTION_OF_SBATCH: partition, account, time limit, memory. Runs have as many threads as
# --cpus-per-task says; 1 without it. Submitted are an array for own scenes and the stage 1 that
# runs share, then one for the rows, each in a file of its own, and a job that merges them into the
# one table. Programs are built here. Anything may be killed at any moment, and this called again
# when no job of it is left. Exit status: 0 if all rows are there, or if jobs were submitted and
# --wait was not given; 1 if some are missing.
# SPDX-License-Identifier: BSD-2-Clause
set -u
cd "$(dirname "$0")/../.." || exit 3
program=slurm.sh takes=" --tasks --at-once " flags=" --wait "
tasks= at_once= wait=
. bench/cluster/driver.sh
command -v sbatch >/dev/null || die "there is no sbatch of Slurm (make deps-cluster)"

# One name for all jobs of this work folder.
name=ted4-$table-$(echo "$work" | sha1sum | cut -c1-8)
queued=$(squeue -h -n "$name" -o %i) || die "Slurm does not answer"
[ -z "$queued" ] || die "jobs of this sweep have not ended: squeue -n $name"

mkdir -p "$work/cluster/logs"
most=$(scontrol show config | awk '$1 == "MaxArraySize" { print $3 }')
[ -n "$tasks" ] && [ "$tasks" -le "${most:-1001}" ] || tasks=${most:-1001}
[ "$tasks" -gt 0 ] || die "--tasks needs at least 1"

# The number of the job is the last line that sbatch prints.
batch() { sbatch --parsable --job-name="$name" --chdir="$PWD" --requeue "$@"; }

# submit OPTION TAGS OPTION_OF_SBATCH...: an array; its number in $after, for what has to follow.
submit() {
    what=$1 runs=$2
    shift 2
    [ -n "$runs" ] || return 0
    list=$work/cluster/$(date +%Y%m%d-%H%M%S)-$$.${what#--}
    echo "$runs" >"$list"
    n=$(wc -l <"$list")
    [ "$n" -le "$tasks" ] || n=$tasks
    job=$(batch --array="0-$((n - 1))${at_once:+%$at_once}" --signal=B:TERM@60 \
        --output="$work/cluster/logs/%A_%a.log" ${after:+"--dependency=afterany:$after"} "$@" \
        bench/cluster/task.sh "$list" "$n" "bench/$table.sh" $missing "$what") ||
        die "sbatch refuses"
    after=${job%%;*}
    echo "$program: job $after: ${what#--}, $(wc -l <"$list") runs in $n tasks"
}

rows --merge
rows --build || exit 3
tags=$(left_rows) || exit 3
[ -n "$tags" ] || { tell_left; exit; }
after=
shared=$(left_shared) || exit 3
submit --shared "$shared" "$@"
submit --row-files "$tags" "$@"
batch --dependency="afterany:$after" --output="$work/cluster/logs/%j.log" ${wait:+--wait} "$@" \
    --wrap "bench/$table.sh --merge" >"$work/cluster/merge.$$"
status=$?
rm -f "$work/cluster/merge.$$"
[ -n "$wait" ] || exit $status
tell_left
