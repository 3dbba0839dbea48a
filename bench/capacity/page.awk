# page.awk - puts bench/capacity.md together, on stdout. Takes -v charts: where charts go.
# SPDX-License-Identifier: BSD-2-Clause

function model(t) {
    return get(t, "n_offsets") "/" get(t, "feature_dim") "/" get(t, "phi_dim") ", " get(t, "bank_rows") "x" get(t, "bank_dim") ", " \
        get(t, "deform_width") "/" get(t, "head_width") ", " get(t, "hyper_layers") "x" get(t, "hyper_width") "/" get(t, "n_slices") "x" get(t, "ar_width") \
        ", " get(t, "view") (get(t, "scale_domain") == 1 ? ", linear" : "")
}

function show_scene(s,    i, v, t, best, b) {
    best = best_fixed(s)
    for (i = 1; i <= n_variants; i++) {
        v = variants[i]
        if (n_runs[s, v] == 0)
            continue
        t = runs[s, v, 1]
        if (!has(t)) {
            row_missing(s "|" v)
            continue
        }
        b = best != "" && cost(t) != "" ? signed(100 * (cost(t) / cost(best) - 1), 1, " %") : "-"
        row(s "|" v mark_of(t) "|" get(t, "bytes") "|" fixed(get(t, "psnr"), 2) "|" fixed(cost(t), 5) "|" b "|" sprintf("%.0f", temporal(t)) "|" \
            fixed(get(t, "cpu_s"), 0) "|" get(t, "trial_steps") "|" fixed(get(t, "decode_ms"), 2) "|" model(t))
    }
}

# A curve of the scenes of a list over the numbers of another: a column, or bytes for time; mean over seeds.
function content_curve(name, v, colour, marker, dash, list, places, column,    n, i, s, x, y) {
    plot_series(name, colour, marker, dash)
    n = split(list, s, " ")
    split(places, x, " ")
    for (i = 1; i <= n; i++) {
        y = mean_over_seeds(s[i], v, column)
        if (y != "")
            plot_point(x[i], y / 1000, "")
    }
}

# Left for which scenes, at which numbers on the axis x.
function content_chart(name, title, x_label, list, places) {
    plot_begin()
    content_curve("auto, file", "auto", "#0072b2", "circle", "", list, places, "bytes")
    content_curve("auto, for time", "auto", "#0072b2", "triangle", "7 4", list, places, "temporal")
    content_curve("fixed, file", "whole", "#d55e00", "square", "", list, places, "bytes")
    content_curve("fixed, for time", "whole", "#d55e00", "diamond", "7 4", list, places, "temporal")
    if (plot_is_empty())
        return
    svg_open(charts "/" name ".svg", 460, 360, title)
    plot_ticks = places
    plot_draw(0, 4, 450, 350, title, x_label, "kB (1000 bytes)", "", 1)
    svg_close()
    say("")
    say("![" title "](capacity/" name ".svg)")
}

function means(s, v) {
    return fixed(mean_over_seeds(s, v, "bytes"), 0) "|" fixed(mean_over_seeds(s, v, "temporal"), 0) "|" fixed(mean_over_seeds(s, v, "dynamic"), 0) "|" \
        fixed(mean_over_seeds(s, v, "psnr"), 2)
}

function content(title, list,    n, i, s) {
    say("")
    say("## " title)
    table("scene,seeds,auto: bytes,of them for time,anchors that move,PSNR,whole (seed 1): bytes,of them for time,anchors that move,PSNR")
    n = split(list, s, " ")
    for (i = 1; i <= n; i++)
        if (mean_over_seeds(s[i], "auto", "bytes") != "")
            row(s[i] mark_of(runs[s[i], "auto", 1]) "|" n_runs[s[i], "auto"] "|" means(s[i], "auto") "|" means(s[i], "whole"))
        else
            row_missing(s[i])
}

function sections(    i) {
    say("")
    say("## Auto against fixed settings")
    say("")
    say("Cost: 0.8 L1 + 0.2 (1 - SSIM) of held-out pictures, plus lambda times the bits of the file over the values of all anchors of the scene's `whole` run, so")
    say("that a bit weighs the same in every run of a scene. For time: bytes of bank, temporal features, activations, and the networks' share. CPU: seconds of")
    say("training, trials included; trials: steps of trained ones. Model: K/F/d, rows x width of the bank, widths of F_deform/heads, hyperprior/slices, view.")
    say("Fixed settings keep all bits of weights; how many are worth theirs is among what auto decides.")
    table("scene,setting,bytes,PSNR,cost,against the best fixed,for time,CPU s,trials,decode ms,model")
    for (i = 1; i <= n_scenes; i++)
        show_scene(scenes[i])
    content("How many things move", "things0 things1 things2 things4 things8")
    content_chart("things", "Size by what moves", "things that move, of eight", "things0 things1 things2 things4 things8", "0 1 2 4 8")
    content("For how long", "things4 long2 long4 rest")
    content_chart("times", "Size by how long it moves", "times", "things4 long2 long4", "16 32 64")
}

END {
    if (failed)
        exit 1
    cost_bar()
    time_bar()
    still_bar("still")
    still_bar("chair")
    still_bar("moment")
    things_bar()
    sections()
    print "# Capacity: no more model than a scene needs"
    print ""
    print "Written by `make capacity` from [capacity.csv](capacity.csv); the runs are those of capacity.txt. The bars are those of the"
    print "lab, by number. †: made by other sources."
    print "Bars: " n_verdicts["met"] + 0 " met, " n_verdicts["**missed**"] + 0 " missed, " n_verdicts["not run yet"] + 0 " not run yet."
    print ""
    print "| # | what | bar | measured | verdict | command, then `bench/capacity_page.sh` |"
    print "|---|---|---|---|---|---|"
    for (i = 1; i <= n_bars; i++)
        print bars[i]
    for (i = 1; i <= n_body; i++)
        print body[i]
}
