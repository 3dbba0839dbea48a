# log.awk - what the logs of ted4enc (JSON lines) tell of one training: stage 1's log, then the run's own. A run that was killed and went on repeats steps; the last
# line of a step counts, and its time is the time that its steps take, so what was lost by killing is not counted. Used by bench/sweep.sh.
#     awk -f log.awk LOG...               wall_s,stage1_wall_s,cpu_s,stage1_cpu_s of the whole training
#     awk -v most=100 -f log.awk LOG...   at most about that many of its lines, as JSON lines with seconds from its beginning
# SPDX-License-Identifier: BSD-2-Clause

function number(name,    v) {
    v = $0
    if (!sub(".*\"" name "\":", "", v))
        return ""
    sub(/[,}].*/, "", v)
    return v
}

# What the watch has found, and trials of smaller models (run_log.h), are no lines of a step.
/^[{]"step":[0-9]+,"event":/ {
    next
}

/^[{]"step":[0-9]+,.*[}]$/ {
    s = number("step") + 0
    if (!(s in stage))
        step[++n] = s
    stage[s] = number("stage")
    gsub(/"/, "", stage[s])
    wall[s] = number("ms")
    cpu[s] = number("cpu_ms")
    kept[s] = "\"step\":" s ",\"stage\":\"" stage[s] "\",\"loss\":" number("loss") ",\"psnr\":" number("psnr") \
        ",\"anchors\":" number("anchors") ",\"bytes\":" number("bytes")
}

# Steps in order: insertion, for they nearly are.
function sort_steps(    i, j, s) {
    for (i = 2; i <= n; i++) {
        s = step[i]
        for (j = i - 1; j >= 1 && step[j] > s; j--)
            step[j + 1] = step[j]
        step[j + 1] = s
    }
}

END {
    sort_steps()
    each = most > 0 && n > most ? int((n + most - 1) / most) : 1
    for (i = 1; i <= n; i++) {
        s = step[i]
        seconds = 1e-3 * wall[s] * (s - step[i - 1])
        work = 1e-3 * cpu[s] * (s - step[i - 1])
        all_s += seconds
        all_cpu += work
        if (stage[s] == "1") {
            first_s += seconds
            first_cpu += work
        }
        if (most > 0 && (i % each == 0 || i == n))
            printf "{%s,\"seconds\":%.1f}\n", kept[s], all_s
    }
    if (!(most > 0))
        printf "%.1f,%.1f,%.1f,%.1f\n", all_s, first_s, all_cpu, first_cpu
}
