#!/bin/sh
# sweeps.sh - a sweep of 12 short trainings gives the same table, except for columns of times, by
# one process, by GNU parallel and by job arrays of Slurm, each of the latter undisturbed and with
# kill -9 of a training, of a job, of the driver and of the merge. Prints lines as a cmocka program
# does; run by `make test-cluster` from the project's root. What is not installed or does not run is
# skipped.
# SPDX-License-Identifier: BSD-2-Clause
set -u
LC_ALL=C; export LC_ALL
unset TED4_WORK TED4_RESULTS
. tests/support/speak.sh
need sweeps ted4enc ted4scene bench/rate_check bench/spans python3
command -v setsid >/dev/null || { skip sweeps "there is no setsid"; exit 0; }
[ -d "$out" ] || exit 1

tiny=size=48x32+cameras=3+test-cameras=1+frames=4+hold=0
cat >"$out/table.txt" <<END
lambdas 0.002 0.006
base    --preset draft --capacity fixed --seed 1 --set stage1=400 --set stage2=300 --set init_anchors=200 --set max_anchors=400
scene turn  own:turn+$tiny
scene blink own:blink+$tiny
run rd      whole      turn,blink 1,2 -
run variant nomotion   turn,blink 1,2 - --set motion=0
run variant notempmask turn,blink 1,2 - --set temporal_mask=0
END
export TED4_TABLE="$out/table.txt"
times='train_s stage1_s cpu_s stage1_cpu_s decode_ms render_fps integer_ms float32_ms float64_ms'

# in_way WAY COMMAND...: runs the command with results and work of its own, and its output in
# WAY.said.
in_way() {
    way=$1
    shift
    TED4_RESULTS=$out/$way TED4_WORK=$out/$way/kept "$@" >>"$out/$way.said" 2>&1
}

# The table of a way without its columns of times.
without_times() {
    awk -F, -v names="$times" '
        NR == 1 { n = split(names, name, " "); for (i = 1; i <= n; i++) skip[name[i]] = 1 }
        NR == 1 { for (i = 1; i <= NF; i++) if ($i in skip) { left[i] = 1; n-- } }
        { for (i = 1; i <= NF; i++) printf "%s,", i in left ? "" : $i; print "" }
        END { if (n) print "columns of times are missing" }' "$out/$1/sweep.csv"
}

# same WAY TEST SECONDS: checks for the 12 rows of one process, and that rows from before a kill
# still have their times: nothing was made twice.
same() {
    without_times "$1" >"$out/$1.rows"
    differ=$(diff "$out/one.rows" "$out/$1.rows") && [ "$(wc -l <"$out/$1.rows")" = 13 ] &&
        [ -z "$(ls "$out/$1/kept/rows")" ] ||
        { fail "$2" "$differ $(tail -n 20 "$out/$1.said")"; return 1; }
    for row in $(find "$out/$1.before" -name '*.row' 2>/dev/null); do
        grep -qxF -e "$(cat "$row")" "$out/$1/sweep.csv" ||
            { fail "$2" "made twice: $(cat "$row")"; return 1; }
    done
    ok "$2"
    echo "result: $2: 12 rows in $3 s, the same table"
}

since() { echo $(($(date +%s) - $1)); }

# pids WAY PATTERN: prints the processes of that way whose command line matches the pattern.
# Programs of GNU parallel and Slurm have the environment with which they were started.
pids() {
    for p in $(grep -lzxF "TED4_RESULTS=$out/$1" /proc/[0-9]*/environ 2>/dev/null); do
        p=${p%/environ}
        { tr '\0' ' ' <"$p/cmdline" | grep -qE -e "$2" && echo "${p#/proc/}"; } 2>/dev/null
    done
}

# kill_when WAY NAME PATTERN CONDITION: kills such a process as soon as there is one and the
# condition holds; if NAME is driver or merge, all of them.
kill_when() {
    tries=0
    while :; do
        tries=$((tries + 1))
        [ $tries -lt 6000 ] || { fail "$1" "no $2 to kill: $(tail -n 20 "$out/$1.said")"; return; }
        if eval "$4"; then
            found=$(pids "$1" "$3")
            case $2 in driver|merge) ;; *) found=$(echo "$found" | head -n 1) ;; esac
            [ -n "$found" ] && kill -9 $found 2>/dev/null && break
        fi
        sleep 0.05
    done
    rows="$(count_rows "$1") rows in files, $(count_merged "$1") merged"
    echo "result: $1: kill -9 of the $2, with $rows"
}
count_rows() { find "$out/$1/kept/rows" -name '*.row' 2>/dev/null | wc -l; }
count_merged() { sed 1d "$out/$1/sweep.csv" 2>/dev/null | wc -l; }

# ---- one process, one run after the other ----

began=$(date +%s)
in_way one bench/sweep.sh --jobs 1 --threads 1 && without_times one >"$out/one.rows" &&
    [ "$(wc -l <"$out/one.rows")" = 13 ] && ok one_process ||
    { fail one_process "$(tail -n 20 "$out/one.said")"; exit 1; }
echo "result: one process: 12 rows in $(since "$began") s"

# undisturbed WAY DRIVER...: runs the whole sweep.
undisturbed() {
    way=$1
    shift
    began=$(date +%s)
    in_way "$way" "$@" && same "$way" "$way" "$(since "$began")" ||
        fail "$way" "$(tail -n 20 "$out/$way.said")"
}

# disturbed WAY JOB GO_ON DRIVER...: kills a training, a job (a process that matches JOB), the
# driver and the merge. GO_ON WAY DRIVER... waits for what the killed driver left, and kills the
# merge.
disturbed() {
    way=$1 job=$2 go_on=$3
    shift 3
    began=$(date +%s)
    in_way "$way" setsid --wait "$@" & driver=$!
    kill_when "$way" training '^[^ ]*/ted4enc ' '[ "$(count_rows $way)" -ge 2 ]'
    kill_when "$way" job "$job" '[ "$(count_rows $way)" -ge 4 ]'
    kill_when "$way" driver 'bench/cluster/[a-z]*\.sh sweep|^perl |sbatch' \
        '[ "$(count_rows $way)" -ge 6 ]'
    wait $driver
    cp -r "$out/$way/kept/rows" "$out/$way.before"
    $go_on "$way" "$@"
    in_way "$way" "$@" && same "$way" "$way" "$(since "$began")" ||
        fail "$way" "$(tail -n 20 "$out/$way.said")"
}

# Waits until no process of that way is left.
no_process() { while [ -n "$(pids "$1" 'sweep|ted4')" ]; do sleep 0.5; done; }

kill_merge() { kill_when "$1" merge 'sweep\.sh --merge' '[ "$(count_merged $way)" -ge 2 ]'; }

# ---- GNU parallel ----

if command -v parallel >/dev/null && parallel --version 2>&1 | grep -q '^GNU parallel'; then
    undisturbed parallel bench/cluster/parallel.sh sweep --jobs 2
    # A second call merges what the first one left.
    go_on_parallel() {
        no_process "$1"
        in_way "$@" & driver=$!
        kill_merge "$1"
        wait $driver
    }
    disturbed parallel_killed '^[^ ]*sh bench/sweep\.sh .*--only' go_on_parallel \
        bench/cluster/parallel.sh sweep --jobs 2
else
    skip parallel "there is no GNU parallel (make deps-cluster)"
fi

# ---- Slurm, of this machine alone ----

# The jobs continue without their driver, the merge last.
go_on_slurm() {
    kill_merge "$1"
    while [ -n "$(squeue -h)" ]; do sleep 1; done
    no_process "$1"
}

if said=$(bench/cluster/one-node.sh start "$out/slurm" 2 2>"$out/slurm.said"); then
    trap 'bench/cluster/one-node.sh stop "$out/slurm"; rm -rf "$out"' EXIT
    set -a; eval "$said"; set +a
    undisturbed slurm bench/cluster/slurm.sh sweep --tasks 5 --wait
    disturbed slurm_killed 'slurm_script|task\.sh' go_on_slurm bench/cluster/slurm.sh sweep \
        --tasks 5 --wait
else
    skip slurm "Slurm does not run here: $(tail -n 1 "$out/slurm.said")"
fi
exit $bad
