# kept.awk - what other pages measured, bench/{raster,render,train,memory}.md: bars 8 and 9 and the links. Used by bench/report.sh.
# SPDX-License-Identifier: BSD-2-Clause

# Lines of a page into line[1..n]; n, 0 when it is not there.
function page_lines(name, line,    n, text) {
    split("", line)
    while ((getline text <(pages "/" name)) > 0)
        line[++n] = text
    close(pages "/" name)
    return n + 0
}

# The number that follows a word in a line, over spaces and brackets; "" without.
function number_after(text, word,    at) {
    at = index(text, word)
    if (at == 0)
        return ""
    text = substr(text, at + length(word))
    sub(/^[ (]+/, "", text)
    return text ~ /^[0-9]/ ? text + 0 : ""
}

# The line of a page that tells the machine: the one after "$ make ...".
function page_machine(line, n,    i) {
    for (i = 1; i < n; i++)
        if (line[i] ~ /^\$ make /)
            return line[i + 1]
    return ""
}

function kept_section() {
    say("")
    say("## Speed and memory")
    say("")
    say("Measured apart, on the machine that each page names.")
    table("page,what,result,command")
    raster_row()
    render_row()
    train_row()
    memory_row()
}

# 100,000 Gaussians with two threads.
function raster_row(    line, n, i, here, both, faster, text, ok) {
    n = page_lines("raster.md", line)
    for (i = 1; i <= n; i++) {
        if (line[i] ~ /Gaussians, 480x270/)
            here = line[i] ~ /^100000 /
        if (here && line[i] ~ /^ *the first, 2 threads /)
            both = number_after(line[i], " both ")
        if (here && line[i] ~ /speed-up by 2 threads/)
            faster = number_after(line[i], "2 threads")
    }
    if (both != "" && faster != "") {
        text = fixed(both, 1) " ms; " fixed(faster, 2) "x; bits equal: asserted by `tests/decoder/test_raster.c`, `tests/encoder/test_raster_grad.c` (`make test`); " \
            page_machine(line, n)
        ok = both <= 20 && faster >= 1.8
    }
    bar(8, "forward plus backward, 100,000 Gaussians, 480x270, two cores", "at most 20 ms (aim 12); 1 to 2 threads at least 1.8x; bits equal", text, ok, \
        "`make bench-raster`: [raster.md](raster.md)")
    row("[raster.md](raster.md)|rasteriser, forward and backward, 100,000 Gaussians, 2 threads|" \
        (text == "" ? "not run yet" : fixed(both, 1) " ms, " fixed(faster, 2) "x of one thread") "|`make bench-raster`")
}

# The slowest preset's median decides: with two threads and the fastest kernels, which come first.
function render_row(    line, n, i, preset, best, median, slowest, text, ok, is_first) {
    n = page_lines("render.md", line)
    for (i = 1; i <= n; i++) {
        if (line[i] ~ /^preset /) {
            preset = line[i]
            sub(/^preset /, "", preset)
            sub(/:.*/, "", preset)
            is_first = 1
        }
        if (line[i] !~ /, 2 threads / || !is_first)
            continue
        is_first = 0
        best = number_after(substr(line[i], index(line[i], "best")), "=")
        median = number_after(substr(line[i], index(line[i], "median")), "=")
        if (best == "" || median == "")
            continue
        text = join(text, "; ", "preset " preset ": " fixed(median, 1) " frames/s (best " fixed(best, 1) ")")
        slowest = slowest == "" || median < slowest ? median : slowest
    }
    ok = slowest == "" ? "" : slowest >= 30
    bar(9, "100,000 visible Gaussians at 960x536, deformation and heads included, two cores", "at least 30 frames/s (aim 73)", \
        text == "" ? "" : text "; " page_machine(line, n), ok, "`make bench-render`: [render.md](render.md)")
    row("[render.md](render.md)|drawing a decoded scene, everything new in each frame, 2 threads, medians|" (text == "" ? "not run yet" : text) \
        "|`make bench-render`")
}

function train_row(    line, n, i, stage, part, text) {
    n = page_lines("train.md", line)
    for (i = 1; i <= n; i++) {
        if (line[i] ~ /: [0-9]+ anchors, /) {
            stage = line[i]
            sub(/:.*/, "", stage)
        }
        if (line[i] ~ /^ *a step /) {
            split(line[i], part, " ")
            text = join(text, "; ", stage ": " part[5] " ms a step, " part[7] "x of one thread")
        }
    }
    row("[train.md](train.md)|a training step by its parts, 2 threads|" (text == "" ? "not run yet" : text) "|`make bench-train`")
}

function memory_row(    line, n, i, c, peak, many) {
    n = page_lines("memory.md", line)
    for (i = 1; i <= n; i++)
        if (split(line[i], c, "|") >= 7 && c[6] + 0 > 0) {
            peak = c[6] + 0 > peak + 0 ? c[6] + 0 : peak
            many++
        }
    row((n ? "[memory.md](memory.md)" : "memory.md") "|300 frames of 20 cameras at 1352x1014 in 8 GB|" \
        (many ? "peak " fixed(peak, 0) " MiB in " many " trainings" : "not run yet") "|`make bench-memory`")
}
