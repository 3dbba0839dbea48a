# log.awk - what the logs of ted4enc (JSON lines) tell of one training: stage 1's log, then the run's own. Times are those of training, with what the trainer threw
# away itself (a new beginning, a rollback) and without what a kill lost.
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

# Seconds count from step 0 in every log, those of the processors from where the log began.
FNR == 1 {
    before = cpu
}

# What the watch has found, and trials of smaller models (run_log.h), are no lines of a step.
/^[{]"step":[0-9]+,"event":/ {
    next
}

/^[{]"step":[0-9]+,.*[}]$/ {
    wall = number("seconds")
    cpu = before + number("cpu_seconds")
    if (number("stage") == "\"1\"") {
        first_wall = wall
        first_cpu = cpu
    }
    kept[++n] = "\"step\":" number("step") ",\"stage\":" number("stage") ",\"loss\":" number("loss") ",\"psnr\":" number("psnr") \
        ",\"anchors\":" number("anchors") ",\"bytes\":" number("bytes") ",\"seconds\":" sprintf("%.1f", wall)
}

END {
    each = most > 0 && n > most ? int((n + most - 1) / most) : 1
    for (i = 1; most > 0 && i <= n; i++)
        if (i % each == 0 || i == n)
            print "{" kept[i] "}"
    if (!(most > 0))
        printf "%.1f,%.1f,%.1f,%.1f\n", wall, first_wall, cpu, first_cpu
}
