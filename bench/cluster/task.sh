#!/bin/sh
# task.sh - a task of an array that slurm.sh submits, from the project's root: a process for each
# of its runs, one after the other.
# Usage:  task.sh LIST TASKS COMMAND...
#     LIST     tags, a line each, of which task I makes lines I, I + TASKS, ... from 0
#     COMMAND  makes one run, with --only TAG
# SIGTERM, which Slurm sends before the time is up, is passed on, so that a training writes its
# checkpoint.
# SPDX-License-Identifier: BSD-2-Clause
set -u
list=$1 tasks=$2
shift 2
child=
trap '[ -z "$child" ] || { kill $child 2>/dev/null; wait $child; }; exit 143' TERM
status=0
for tag in $(awk -v first="$SLURM_ARRAY_TASK_ID" -v tasks="$tasks" \
    '(NR - 1) % tasks == first' "$list"); do
    "$@" --jobs 1 --threads "${SLURM_CPUS_PER_TASK:-1}" --only "$tag" & child=$!
    wait $child || status=1
done
exit $status
