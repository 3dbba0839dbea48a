#!/bin/sh
# parallel.sh - makes the missing and stale rows of a table of runs by GNU parallel, on this machine
# or on several that share this folder. bench/cluster.md tells how.
# Usage, from anywhere:  bench/cluster/parallel.sh TABLE [PATTERN...]
#                             [--missing] [--jobs N] [--threads N] [-- OPTION_OF_PARALLEL...]
#     TABLE        sweep, stability, capacity, zoo, bd_rate or held_out
#     PATTERN..., --missing, and the environment    as bench/sweep.sh, bench/stability.sh, ... take
#                                                   them
#     --jobs N     runs at a time on each machine; as many as it has cores without it
#     --threads N  threads of each; 1 without it
# First come the programs, own scenes and the stage 1 that runs share, then the rows, each in a file
# of its own, and last the merge into the one table. May be killed at any moment and called again.
# Exit status: 0 if all rows are there, 1 if some are missing.
# SPDX-License-Identifier: BSD-2-Clause
set -u
cd "$(dirname "$0")/../.." || exit 3
program=parallel.sh takes=" --jobs --threads " flags=" "
jobs=100% threads=1
. bench/cluster/driver.sh
command -v parallel >/dev/null || die "there is no GNU parallel (make deps-cluster)"

# in_parallel OPTION TAGS PARALLEL_OPTION...: a process for each tag.
in_parallel() {
    what=$1 runs=$2
    shift 2
    [ -n "$runs" ] || return 0
    for variable in TED4_BUILD TED4_DATA TED4_WORK TED4_RESULTS TED4_TABLE TED4_KERNEL; do
        set -- --env $variable "$@"
    done
    echo "$runs" | parallel --jobs "$jobs" --workdir "$PWD" --line-buffer "$@" \
        "bench/$table.sh" $missing --jobs 1 --threads "$threads" "$what" --only
}

rows --merge
rows --build || exit 3
tags=$(left_shared) || exit 3
in_parallel --shared "$tags" "$@"
tags=$(left_rows) || exit 3
in_parallel --row-files "$tags" "$@"
rows --merge
tell_left
