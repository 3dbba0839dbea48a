#!/bin/sh
# step_time.sh - the time of a training step by two processes of one thread against one: medians of
# runs in turn, and their ratio. Needs `make all mpi`.
# Usage, from anywhere:  bench/cluster/step_time.sh [ROUNDS [SCENE [OPTION_OF_TED4ENC...]]]
# ROUNDS is 3 without it; SCENE is kitchen, at half size. For each number of processes: milliseconds
# a step on the clock, and of processor time of the first process, which draws the most; waiting for
# the others is part of both. Medians over the lines of the logs, without the first of each.
# SPDX-License-Identifier: BSD-2-Clause
set -u
LC_ALL=C; export LC_ALL
cd "$(dirname "$0")/../.." || exit 3
build=${TED4_BUILD:-build}
rounds=${1:-3}
[ $# -lt 1 ] || shift
[ $# -gt 0 ] || set -- "${TED4_DATA:-../shared/data}/kitchen" --downscale 2
[ -x "$build/ted4enc-mpi" ] || { echo "step_time.sh: make all mpi first" >&2; exit 3; }
out=$(mktemp -d) || exit 3
trap 'rm -rf "$out"' EXIT

launch="mpirun --bind-to core" # one thread each
[ "$(id -u)" != 0 ] || launch="$launch --allow-run-as-root"

set -- "$@" --preset draft --capacity fixed --set batch=4 --set stage1=400 --set stage2=400 -j 1 \
    -f -q

# What comes before the first step is done once.
"$build/ted4enc" "$@" -o "$out/begin.ted4" --checkpoint "$out/begin" --checkpoint-every 1 &
while kill -0 $! 2>/dev/null && [ ! -f "$out/begin" ]; do sleep 0.1; done
kill $! && wait $!
[ -f "$out/begin" ] || exit 1
for round in $(seq "$rounds"); do
    for n in 1 2; do
        cp "$out/begin" "$out/point"
        $launch -n $n "$build/ted4enc-mpi" "$@" -o "$out/$n.ted4" --log "$out/$n.$round.log" \
            --checkpoint "$out/point" --checkpoint-every 3600 --resume || exit 1
    done
    cmp "$out/1.ted4" "$out/2.ted4" || exit 1
done
python3 - "$out" "$rounds" <<'END'
import json
import statistics
import sys

def median(n, key):
    rows = []
    for r in range(int(sys.argv[2])):
        with open(f"{sys.argv[1]}/{n}.{r + 1}.log") as f:
            lines = [json.loads(line) for line in f]
        rows += [line[key] for line in lines if key in line][1:]
    return statistics.median(rows)

for key, name in ("ms", "the clock"), ("cpu_ms", "processor"):
    one, two = median(1, key), median(2, key)
    print(f"{name:10} 1 x 1: {one:7.2f} ms   2 x 1: {two:7.2f} ms   ratio {one / two:.2f}")
END
