# tables.awk - the page's tables: quality of every scene and variant, anchors thrown out, what the whole method's runs measured, failures with their causes,
# strips, commands.
# SPDX-License-Identifier: BSD-2-Clause

# Titles of a table with a column for each variant.
function variant_titles(first,    i, text) {
    text = first
    for (i = 1; i <= n_lab; i++)
        text = text "," lab[i]
    return text
}

function any_old(s, v,    i) {
    for (i = 1; i <= n_runs[s, v]; i++)
        if (is_old(runs[s, v, i]))
            return "†"
    return ""
}

# Mean and worst of a scene and variant: means over seeds, and the spread between seeds of the mean.
function quality_cell(s, v,    marks, n) {
    n = count_runs(s, v)
    if (n == 0)
        return "-"
    marks = marks_of(s, v)
    return fixed(mean_of(s, v, "psnr"), 2) " / " fixed(mean_of(s, v, "worst"), 2) (spread_of(s, v) == "" ? "" : " ±" fixed(spread_of(s, v) / 2, 2)) \
        (n < n_runs[s, v] ? " (" n " of " n_runs[s, v] ")" : "") any_old(s, v) (marks == "" ? "" : " **" marks "**")
}

function quality_section(    k, i, cells) {
    say("")
    say("## Every scene and variant")
    say("")
    say("PSNR in dB on held-out pictures that training never saw, drawn from the decoded file: mean of all / worst of all, both as means")
    say("over seeds; ± half the span of the mean over seeds. Bold letters mark failures, with the number of seeds where not all fail:")
    say("")
    for (i = 1; i in rule_order; i++)
        say("* **" letter[rule_order[i]] "**: " meaning[rule_order[i]])
    table(variant_titles("scene"))
    for (k = 1; k <= n_scenes; k++) {
        cells = scenes[k]
        for (i = 1; i <= n_lab; i++)
            cells = cells "|" quality_cell(scenes[k], lab[i])
        row(cells)
    }
    show_lab_chart("worst", "Worst held-out frame by scene and variant, mean and span over seeds")
    show_lab_chart("mean", "Mean PSNR by scene and variant, mean and span over seeds")
}

function show_lab_chart(name, text) {
    say("")
    say(name in drawn ? "![" text "](lab/" name ".svg)" : "*" text "*: not run yet.")
}

function percent(x, digits) { return x == "" ? "-" : sprintf("%." digits "f %%", 100 * x) }

function out_section(    k, i, s, cells) {
    say("")
    say("## Anchors thrown out of view")
    say("")
    say("An anchor is *thrown out* when at a time at which something trains it is drawn (one of its Gaussians is at least as opaque as the")
    say("rasteriser asks, 1/255) while its centre (the mean of those of its Gaussians) lies in the picture of none of that time's training")
    say("cameras, although at another such time its centre lies where one of these same cameras sees it: so the anchor was moved, not the")
    say("camera. Share of the anchors that are drawn at all; largest displacement while drawn, in sizes of the scene (the longest side of the")
    say("box between the 1st and the 99th percentile of its initial points). Means over seeds.")
    table(variant_titles("scene"))
    for (k = 1; k <= n_scenes; k++) {
        s = scenes[k]
        cells = s
        for (i = 1; i <= n_lab; i++)
            cells = cells "|" (!count_runs(s, lab[i]) ? "-" : percent(mean_of(s, lab[i], "out_share"), 2) "; " \
                fixed(mean_of(s, lab[i], "displacement"), 3) any_old(s, lab[i]))
        row(cells)
    }
    show_lab_chart("out", "Share of drawn anchors thrown out of every picture, by scene and variant")
}

# The largest of a number of the scene's runs, with the term that a second column names.
function term_cell(s, v, column,    i, t, best, g) {
    for (i = 1; i <= n_runs[s, v]; i++) {
        t = runs[s, v, i]
        if ((g = get(t, column)) != "" && (best == "" || g + 0 > get(best, column) + 0))
            best = t
    }
    return best == "" ? "-" : sprintf("%.3g", get(best, column)) " (" get(best, column "_term") ")"
}

# Cells of the whole method's means of columns divided by spaces, rounded, as percent if share.
function means(s, names, digits, share,    n, i, name, text) {
    n = split(names, name, " ")
    for (i = 1; i <= n; i++)
        text = join(text, "|", (share ? percent(mean_of(s, "whole", name[i]), digits) : fixed(mean_of(s, "whole", name[i]), digits)))
    return text
}

function numbers_section(    k, s) {
    say("")
    say("## What the whole method's runs measured")
    say("")
    say("Means over seeds; gradients and rollbacks: the most of them. *Dead*: share of Gaussians whose opacity is 0 at all times. *Ends*: shares")
    say("of symbols, steps, contexts, sigma indices and activation widths at the ends of their ranges. *Loss*: distortion at the first line of the")
    say("log and at the last, running means over about 100 steps. *Clamped*: values of anchors at an end of their range when training ended.")
    say("*Not finite*: pictures and times that the decoder refused, Gaussians that training left out, lines of the log. *Peak*: largest norm of a gradient as a")
    say("multiple of its term's usual one.")
    table("scene,bytes,anchors,moving,dead,escapes,ends: symbols,steps,contexts,sigma,widths,clamped,not finite,loss,largest gradient,peak,rollbacks," \
        "training s of CPU")
    for (k = 1; k <= n_scenes; k++) {
        s = scenes[k]
        if (!count_runs(s, "whole")) {
            row_missing(s)
            continue
        }
        row(s any_old(s, "whole") "|" means(s, "bytes anchors dynamic", 0, 0) "|" means(s, "dead", 1, 1) "|" \
            means(s, "escape_share symbol_ends step_ends context_ends", 3, 1) "|" means(s, "sigma_ends width_ends", 2, 1) "|" means(s, "clamped", 0, 0) \
            "|" sum_of(s, "whole", "refused_views") + sum_of(s, "whole", "refused_times") + sum_of(s, "whole", "log_bad") + sum_of(s, "whole", "skipped") \
            "|" fixed(mean_of(s, "whole", "loss_first"), 4) " to " fixed(mean_of(s, "whole", "loss_last"), 4) \
            "|" term_cell(s, "whole", "gradient") "|" term_cell(s, "whole", "peak") \
            "|" (most_of(s, "whole", "rollbacks") == "" ? "-" : most_of(s, "whole", "rollbacks")) "|" fixed(mean_of(s, "whole", "cpu_s"), 1))
    }
}

# What ended the runs that have no file.
function said_of(s, v,    i, t, text) {
    for (i = 1; i <= n_runs[s, v]; i++) {
        t = runs[s, v, i]
        if (get(t, "why") != "" && index(text, get(t, "why")) == 0)
            text = join(text, "; ", get(t, "why"))
    }
    return text == "" ? "" : ": " text
}

function failure_words(s, v,    i, n, text) {
    for (i = 1; i in rule_order; i++)
        if ((n = count_breaks(s, v, rule_order[i])) > 0)
            text = join(text, "; ", meaning[rule_order[i]] " (" n " of " count_runs(s, v) ")")
    return text said_of(s, v)
}

# The whole method's first, then the variants'. Counts n_failures, n_unexplained of the whole method.
function failure_section(    k, i, s, cause, key) {
    say("")
    say("## Failures and their causes")
    say("")
    say("Causes and mends are written by hand in [stability-notes.md](stability-notes.md).")
    table("scene,variant,what fails,cause and mend")
    for (i = 1; i <= n_lab; i++)
        for (k = 1; k <= n_scenes; k++) {
            s = scenes[k]
            if (marks_of(s, lab[i]) == "")
                continue
            cause = note_of(s, lab[i])
            if (lab[i] == "whole") {
                n_failures++
                n_unexplained += cause == ""
            }
            row(s "|" lab[i] "|" failure_words(s, lab[i]) "|" (cause != "" ? cause : lab[i] == "whole" ? "**unexplained**" : "-"))
        }
    for (k = 1; k <= n_scenes; k++)
        for (i = 1; i <= n_lab; i++)
            if ((scenes[k] " " lab[i]) in unread || (i == 1 && (scenes[k] " *") in unread)) {
                say("")
                say("Of what no longer fails, on " scenes[k] ": " note_of(scenes[k], lab[i]))
            }
}

function strip_section(    i, t) {
    say("")
    say("## Worst frames")
    say("")
    say("Truth, ours, error (5 times) of the worst held-out picture of the whole method's first seed.")
    table("scene,worst dB,frame,camera,strip")
    for (i = 1; i <= n_tags; i++) {
        t = tag[i]
        if (!keeps(t, "strip"))
            continue
        if (has(t) && get(t, "worst") != "")
            row(name_of(t) "|" values(t, "worst:2 worst_frame worst_camera") "|![" scene[t] "](lab/" t ".jpg)")
        else
            row_missing(t)
    }
}

function command_section(    i, t) {
    say("")
    say("## Commands")
    say("")
    say("`make stability` runs what is missing and writes this page; `bench/stability.sh PATTERN...` runs parts, `bench/stability.sh --only TAG` one")
    say("(for a cluster's job array), `bench/stability_page.sh` writes the page. Scenes `own:NAME+size=96x64` are made by `ted4scene NAME --size")
    say("96x64 -o FOLDER`. † marks what older sources or other options made. [stability.csv](stability.csv) has all columns." \
        (strangers ? " It holds " strangers " rows that stability.txt no longer wants; they are not shown." : ""))
    table("run,command,key")
    for (i = 1; i <= n_tags; i++) {
        t = tag[i]
        if (place[t] == 1 && variant[t] == "whole")
            row(name_of(t) "|`ted4enc " where[t] " " (has(t) ? get(t, "options") : options[t]) "`|" (has(t) ? get(t, "key") : "not run yet"))
    }
    say("")
    say("Other seeds and variants differ by:")
    table("variant,options")
    for (i = 1; i <= n_lab; i++)
        row(lab[i] "|" (lab[i] == "whole" ? "" : "`" own_options(runs[scenes[1], lab[i], 1]) "`"))
}

# Options of a run that the whole method's run of the same place does not have.
function own_options(t,    word, n, i, text, base) {
    base = " " options[runs[scene[t], "whole", 1]] " "
    n = split(options[t], word, " ")
    for (i = 1; i <= n; i++)
        if (word[i] == "--set" && index(base, " --set " word[i + 1] " ") == 0)
            text = join(text, " ", "--set " word[i + 1])
    return text
}
