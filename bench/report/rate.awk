# rate.awk - rate and distortion of the whole method: bar 1, first half. Used by bench/report.sh.
# SPDX-License-Identifier: BSD-2-Clause

# 1: bytes and PSNR fall with every step of lambda; "" when a run is missing.
function is_monotone(s,    i, t, u) {
    if (count_runs(s, "whole") < n_runs[s, "whole"] || n_runs[s, "whole"] < 4)
        return ""
    for (i = 2; i <= n_runs[s, "whole"]; i++) {
        t = runs[s, "whole", i - 1]
        u = runs[s, "whole", i]
        if (!(get(u, "bytes") + 0 < get(t, "bytes") + 0 && get(u, "psnr") + 0 < get(t, "psnr") + 0))
            return 0
    }
    return 1
}

function rate_section(    k, s, m, all, text, tags) {
    say("## Rate and distortion")
    say("")
    say("The whole method at four λ, one stage 1 for all of a scene, measured on decoded files, on pictures that training never saw. Times are of")
    say("one thread; frames a second with the run's threads; both were taken beside the other jobs of the sweep, and vary with them. *moving*: anchors")
    say("with a temporal feature.")
    for (k = 1; k <= n_curve_scenes; k++) {
        s = curve_scenes[k]
        rate_rows(s)
        m = is_monotone(s)
        text = join(text, ", ", s ": " (m == "" ? "not run yet" : m ? "yes" : "no"))
        all = all m
        tags = tags " " tags_of(s, "whole")
    }
    rate_chart()
    all = all ~ /0/ ? 0 : n_curve_scenes > 0 && length(all) == n_curve_scenes ? 1 : ""
    bar(1, "PSNR over bytes at four λ: " list_scenes(), "PSNR and bytes fall with every λ", text mark_of(tags), all, sweep("rd"))
}

function list_scenes(    k, text) {
    for (k = 1; k <= n_curve_scenes; k++)
        text = join(text, ", ", curve_scenes[k])
    return text
}

# All tags of a variant on a scene, divided by spaces.
function tags_of(s, v,    i, text) {
    for (i = 1; i <= n_runs[s, v]; i++)
        text = join(text, " ", runs[s, v, i])
    return text
}

function rate_rows(s,    i, t) {
    say("")
    say("### " s)
    table("run,λ,PSNR dB,SSIM,SSIM_2,MS-SSIM,bytes,anchors,moving,Gaussians,decode ms,frames/s")
    for (i = 1; i <= n_runs[s, "whole"]; i++) {
        t = runs[s, "whole", i]
        if (has(t))
            row(name_of(t) "|" lambda[t] "|" values(t, "psnr:2 ssim:4 ssim2:4 ms_ssim:4 bytes anchors dynamic gaussians decode_ms:1 render_fps:0"))
        else
            row_missing(t "|" lambda[t])
    }
}

# A panel a scene, two beside each other.
function rate_chart(    k, height, any) {
    for (k = 1; k <= n_curve_scenes; k++)
        any += count_runs(curve_scenes[k], "whole")
    if (any) {
        height = int((n_curve_scenes + 1) / 2) * 320
        chart_open("rate", 900, height + 8, "PSNR over bytes of the whole method at four λ, by scene")
        for (k = 1; k <= n_curve_scenes; k++) {
            plot_begin()
            plot_curve(curve_scenes[k], "whole", "the whole method", scene_colour(curve_scenes[k]), scene_marker(curve_scenes[k]), "", 1)
            plot_draw((k - 1) % 2 * 450, int((k - 1) / 2) * 320 + 4, 450, 316, curve_scenes[k], "size of the file, kB (1000 bytes)", "PSNR, dB", "", 1)
        }
        svg_close()
    }
    show_chart("rate", "PSNR over bytes, whole method, by scene; numbers at the points are λ; the axes differ")
}

# A variant's runs on a scene as a series. notes: with λ at the points.
function plot_curve(s, v, name, colour, marker, dash, notes,    i, t) {
    plot_series(name, colour, marker, dash)
    for (i = 1; i <= n_runs[s, v]; i++) {
        t = runs[s, v, i]
        if (has(t))
            plot_point(get(t, "bytes") / 1000, get(t, "psnr"), notes ? lambda[t] : "")
    }
}
