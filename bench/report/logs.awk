# logs.awk - thinned training logs, bench/logs/TAG.jsonl, and how loss, PSNR, anchors and bytes go over time. Used by bench/report.sh.
# SPDX-License-Identifier: BSD-2-Clause

# Lines of a run's log into step[1..n] as text; n, 0 without a log.
function log_lines(t, line,    n, text, file) {
    file = results "/logs/" t ".jsonl"
    while ((getline text <file) > 0)
        if (text ~ /^[{].*[}]$/)
            line[++n] = text
    close(file)
    return n + 0
}

# The number that a line has under a name; "" without.
function log_number(line, name) {
    if (!sub(".*\"" name "\":", "", line))
        return ""
    sub(/[,}].*/, "", line)
    return line == "null" ? "" : line + 0
}

function log_section(    t, i, any) {
    say("")
    say("## A training as it goes")
    say("")
    say("From the logs that `ted4enc --log FILE` writes, thinned to about 100 lines each in `bench/logs`: loss; PSNR of the model in training on")
    say("a few held-out pictures; anchors; bytes as estimated (stage 2 only). Seconds as they passed, without what was lost by interruptions. The")
    say("whole method at λ 0.002.")
    any = 0
    for (i = 1; i <= n_curve_scenes; i++) {
        t = log_of(curve_scenes[i])
        any += t != "" && log_lines(t, line) > 0
    }
    if (any) {
        chart_open("progress", 900, 672, "Loss, PSNR, anchors and bytes over training time")
        progress_panel("loss", 0, 4, "Loss", "loss", 1)
        progress_panel("psnr", 450, 4, "Quality", "PSNR, dB", 1)
        progress_panel("anchors", 0, 340, "Anchors", "anchors, thousands", 1000)
        progress_panel("bytes", 450, 340, "Size", "estimated size, kB (1000 bytes)", 1000)
        svg_close()
    }
    show_chart("progress", "Loss, PSNR, anchors and estimated bytes over seconds of training")
}

# The run of the whole method on a scene that keeps a log and has one.
function log_of(s,    i, t, unused) {
    for (i = 1; i <= n_runs[s, "whole"]; i++) {
        t = runs[s, "whole", i]
        if (keeps(t, "log") && has(t) && log_lines(t, unused) > 0)
            return t
    }
    return ""
}

function progress_panel(name, left, top, title, label, unit,    k, s, i, n, line, v) {
    plot_begin()
    for (k = 1; k <= n_curve_scenes; k++) {
        s = curve_scenes[k]
        if (log_of(s) == "")
            continue
        plot_series(s, scene_colour(s), "none", k == 1 ? "" : k == 2 ? "7 4" : k == 3 ? "2 4" : "9 4 2 4")
        split("", line)
        n = log_lines(log_of(s), line)
        for (i = 1; i <= n; i++) {
            v = log_number(line[i], name)
            if (v != "" && (name != "bytes" || v > 0))
                plot_point(log_number(line[i], "seconds"), v / unit)
        }
    }
    plot_draw(left, top, 450, 328, title, "time, s", label, "", 1)
}
