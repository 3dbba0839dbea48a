# precision.awk - quantisation steps and precision of the entropy networks against bytes, PSNR and decode time: bar 10.
# Used by bench/report.sh.
# SPDX-License-Identifier: BSD-2-Clause

BEGIN {
    n_steps = split("steps0.5 whole steps2 steps4", step_variant, " ")
    split("0.5 1 2 4", step_factor, " ")
    split("integer float32 float64", precisions, " ")
}

# The run of a step factor, at the lambda of the others.
function step_run(s, j) { return s "-" step_variant[j] "-2" }

# Bytes that the file would have with networks of that precision, milliseconds that decoding it would take; "" when not known.
function precise_bytes(t, p) { return get(t, p "_bits") == "" ? "" : get(t, "bytes") + (get(t, p "_bits") - get(t, "integer_bits")) / 8 }
function precise_ms(t, p) { return get(t, p "_ms") == "" ? "" : get(t, "decode_ms") - get(t, "integer_ms") + get(t, p "_ms") }

function precision_section(    k, j, s, t, wanted, there, text, tags) {
    say("")
    say("## Precision")
    say("")
    say("Steps Q0 of features, scalings and offsets times a factor, each trained so; and the entropy model in integers, as coded, or in floating")
    say("point (`bench/rate_check FILE.ted4`): the bytes that the file would have with networks of that precision and the same coder, and the")
    say("time to decode it: that of the file on one thread, less the integer networks, plus those. Pictures do not depend on it. Floating-point")
    say("networks would not decode alike on another machine: that is what the integers are for.")
    table("run,Q0 times,PSNR dB,bytes: integer,float32,float64,decode ms: integer,float32,float64,of it networks: integer,float32,float64")
    for (k = 1; k <= n_scenes; k++) {
        s = scenes[k]
        if (!wants(s, "steps2", "precision"))
            continue
        for (j = 1; j <= n_steps; j++) {
            t = step_run(s, j)
            precision_row(t, step_factor[j])
            wanted++
            there += get(t, "float64_bits") != ""
            tags = tags " " t
        }
        if (precision_text(s) != "")
            text = join(text, "; ", precision_text(s))
    }
    precision_chart()
    if (there)
        text = there " of " wanted " runs drawn" mark_of(tags) ": [precision](charts/precision.svg)" (text == "" ? "" : "; " text)
    bar(10, "Q0 and network precision (float64, float32, integer as coded) against bytes, PSNR and decode time", "one chart", text, \
        wanted > 0 && there == wanted ? 1 : "", sweep("precision rd"))
}

function precision_row(t, factor,    p, bytes, ms, networks) {
    if (get(t, "float64_bits") == "") {
        row_missing(name_of(t) "|" factor)
        return
    }
    for (p = 1; p <= 3; p++) {
        bytes = bytes "|" fixed(precise_bytes(t, precisions[p]), 0)
        ms = ms "|" fixed(precise_ms(t, precisions[p]), 1)
        networks = networks "|" fixed(get(t, precisions[p] "_ms"), 1)
    }
    row(name_of(t) "|" factor "|" fixed(get(t, "psnr"), 2) bytes ms networks)
}

# What integers cost a scene at factor 1.
function precision_text(s,    t, b) {
    t = step_run(s, 2)
    b = precise_bytes(t, "float64")
    if (b == "")
        return ""
    return s ": integers " signed(100 * (get(t, "bytes") / b - 1), 3, " %") " bytes against float64, decoding " fixed(precise_ms(t, "integer"), 0) \
        " ms (float32 " fixed(precise_ms(t, "float32"), 0) ", float64 " fixed(precise_ms(t, "float64"), 0) ")"
}

# Four panels over the factor. Colour and marker tell the scene; solid the integers, dashed float32, dotted float64.
function precision_chart(    k, j, any) {
    any = 0
    for (k = 1; k <= n_curve_scenes; k++)
        for (j = 1; j <= n_steps; j++)
            any += wants(curve_scenes[k], "steps2", "precision") && get(step_run(curve_scenes[k], j), "float64_bits") != ""
    if (any) {
        chart_open("precision", 900, 688, "Steps and precision of the networks against bytes, PSNR and decode time")
        precision_panel("psnr", 0, 4, "Quality (the same for every precision)", "PSNR, dB")
        precision_panel("bytes", 450, 4, "Size, integers as coded", "kB (1000 bytes)")
        precision_panel("excess", 0, 346, "Size against networks in float64", "more bytes, %")
        precision_panel("ms", 450, 346, "Time to decode, one thread", "ms")
        svg_close()
    }
    show_chart("precision", "Steps Q0 (times a factor) and precision of the entropy networks against PSNR, bytes and decode time")
}

function precision_panel(what, left, top, title, label,    k, p, s) {
    plot_begin()
    for (k = 1; k <= n_curve_scenes; k++) {
        s = curve_scenes[k]
        if (!wants(s, "steps2", "precision"))
            continue
        if (what == "psnr" || what == "bytes")
            precision_series(s, what, "integer", s, "")
        else
            for (p = 1; p <= 3; p++)
                if (what == "ms" || p < 3)
                    precision_series(s, what, precisions[p], s " " precisions[p], p == 1 ? "" : p == 2 ? "7 4" : "2 4")
    }
    plot_ticks = "0.5 1 2 4"
    plot_draw(left, top, 450, 338, title, "steps: Q0 times", label, "x", 1)
}

function precision_series(s, what, p, name, dash,    j, t, y) {
    plot_series(name, scene_colour(s), p == "integer" ? scene_marker(s) : "ring", dash)
    for (j = 1; j <= n_steps; j++) {
        t = step_run(s, j)
        if (get(t, "float64_bits") == "")
            continue
        y = what == "psnr" ? get(t, "psnr") : what == "bytes" ? get(t, "bytes") / 1000 : what == "ms" ? precise_ms(t, p) \
            : 100 * (precise_bytes(t, p) / precise_bytes(t, "float64") - 1)
        plot_point(step_factor[j], y)
    }
}
