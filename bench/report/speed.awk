# speed.awk - what time buys: PSNR over training time by preset, over the time to decode and draw: bar 5. Used by bench/report.sh.
# SPDX-License-Identifier: BSD-2-Clause

BEGIN {
    n_presets = split("draft fast medium slow paper", presets, " ")
    split("#56b4e9 #0072b2 #009e73 #e69f00 #d55e00", preset_colour, " ")
    split("down circle square triangle diamond", preset_marker, " ")
}

function speed_section(    k, j, s, wanted, there, tags) {
    say("")
    say("## Speed against accuracy")
    say("")
    say("Every preset at its λ, with the capacity that it has (`--capacity fixed`, as all rows of the sweep; what choosing it takes and gives is in")
    say("[capacity.md](capacity.md)). Core seconds: of all threads together, stage 1 included; they compare whatever ran beside. Seconds: as")
    say("they passed. A picture: decoding the whole file on one thread, then drawing one picture with the run's threads, beside the sweep's other jobs:")
    say("what a quiet machine does is in [render.md](render.md) and [decode.md](decode.md).")
    table("run,preset,core s,of it stage 1,s,jobs x threads,PSNR dB,bytes,decode ms,frames/s,decode + picture ms")
    for (k = 1; k <= n_scenes; k++) {
        s = scenes[k]
        for (j = 1; j <= n_presets; j++)
            if (wants(s, presets[j], "preset")) {
                preset_row(runs[s, presets[j], 1], presets[j])
                wanted++
                there += has(runs[s, presets[j], 1])
                tags = tags " " runs[s, presets[j], 1]
            }
    }
    training_chart()
    picture_chart()
    for (k = 1; k <= n_curve_scenes; k++) {
        wanted += n_runs[curve_scenes[k], "whole"]
        there += count_runs(curve_scenes[k], "whole")
        tags = tags " " tags_of(curve_scenes[k], "whole")
    }
    bar(5, "speed against accuracy", "PSNR over training time of every preset, over decode-plus-render time; bytes by syntax element over λ", \
        there ? there " of " wanted " runs drawn" mark_of(tags) ": [one](charts/training.svg), [two](charts/picture.svg), [three](charts/bytes.svg)" : "", \
        wanted > 0 && there == wanted ? 1 : "", sweep("preset rd"))
}

function preset_row(t, preset) {
    if (has(t))
        row(name_of(t) "|" preset "|" values(t, "cpu_s:0 stage1_cpu_s:0 train_s:0 team psnr:2 bytes decode_ms:1 render_fps:0") "|" \
            fixed(picture_ms(t), 1))
    else
        row_missing(t "|" preset)
}

# A panel a scene that has presets. Lines: from the logs, their seconds turned into core seconds; large marks: the decoded file.
function training_chart(    k, j, s, n, list, any) {
    for (k = 1; k <= n_scenes; k++)
        for (j = 1; j <= n_presets; j++)
            if (wants(scenes[k], presets[j], "preset")) {
                list[++n] = scenes[k]
                break
            }
    any = 0
    for (k = 1; k <= n; k++)
        for (j = 1; j <= n_presets; j++)
            any += count_runs(list[k], presets[j])
    if (any) {
        chart_open("training", 900, int((n + 1) / 2) * 360 + 8, "PSNR over training time by preset")
        for (k = 1; k <= n; k++) {
            plot_begin()
            for (j = 1; j <= n_presets; j++)
                if (n_runs[list[k], presets[j]] > 0)
                    training_series(runs[list[k], presets[j], 1], j)
            plot_draw((k - 1) % 2 * 450, int((k - 1) / 2) * 360 + 4, 450, 352, list[k], "training time, core seconds", "PSNR, dB", "x", 1)
        }
        svg_close()
    }
    show_chart("training", "PSNR over training time for every preset; marks: held-out pictures from the decoded file; lines: the log's " \
        "preview, from 6 dB below its end")
}

function training_series(t, j,    i, n, line, scale, p, last) {
    plot_series(presets[j], preset_colour[j], preset_marker[j], "-")
    if (!has(t))
        return
    plot_point(get(t, "cpu_s"), get(t, "psnr"))
    n = log_lines(t, line)
    if (n < 2 || get(t, "train_s") + 0 <= 0)
        return
    scale = get(t, "cpu_s") / get(t, "train_s")
    last = log_number(line[n], "psnr")
    plot_series("", preset_colour[j], "none", "")
    for (i = 1; i <= n; i++) {
        p = log_number(line[i], "psnr")
        if (p != "" && p > last - 6)
            plot_point(log_number(line[i], "seconds") * scale, p)
    }
}

# A series a scene for the λ of the whole method, another for its presets.
function picture_chart(    k, j, i, s, t) {
    plot_begin()
    for (k = 1; k <= n_curve_scenes; k++) {
        s = curve_scenes[k]
        plot_series(s ", four λ", scene_colour(s), scene_marker(s), "")
        for (i = 1; i <= n_runs[s, "whole"]; i++) {
            t = runs[s, "whole", i]
            if (has(t))
                plot_point(picture_ms(t), get(t, "psnr"), i == 1 ? lambda[t] : "")
        }
    }
    plot_above = 1
    for (k = 1; k <= n_curve_scenes; k++) {
        s = curve_scenes[k]
        plot_series(s ", presets", scene_colour(s), "ring", "-")
        for (j = 1; j <= n_presets; j++) {
            t = runs[s, presets[j], 1]
            if (wants(s, presets[j], "preset") && has(t))
                plot_point(picture_ms(t), get(t, "psnr"), presets[j])
        }
    }
    plot_above = 0
    if (!plot_is_empty()) {
        chart_open("picture", 900, 488, "PSNR over the time to decode a file and draw a picture")
        plot_draw(0, 4, 900, 480, "Decoding a file and drawing a picture", "time to decode the file (one thread) and draw one picture, ms", \
            "PSNR, dB", "x", 1)
        svg_close()
    }
    show_chart("picture", "PSNR over the time to decode a file and draw one picture; notes: least λ, preset")
}
