# variants.awk - the whole method with one thing changed: bar 1, second half. Used by bench/report.sh; arithmetic in compare.awk.
# SPDX-License-Identifier: BSD-2-Clause

BEGIN {
    name_family(1, "Deformation", "concat inr inr_paper nomotion static plain")
    name_family(2, "Time", "noactive noprogress notempmask hardmask nosprouts recipe")
    name_family(3, "Prior", "factorised factorised_flat factorised_auto factorised_flat_auto factorised_long factorised_moremask factorised_flat_moremask")
    name_family(4, "Rate", "noautoreg nooffmask moremask linscale")
    name_family(5, "Colour", "noview fullview nocolour")
    name_family(N_FAMILIES = 6, "Other", "")
    # The paper's table of ablations: Neu3D, highest rate, at the same lambda; the prior's figure is a BD-rate.
    paper["concat"] = "−0.98 dB, −0.5 % bytes"
    paper["inr_paper"] = "−2.53 dB, +141 % bytes (a far larger network)"
    paper["noactive"] = "−0.25 dB, +5.7 % bytes"
    paper["noprogress"] = "−0.81 dB, −14.7 % bytes"
    paper["static"] = "−3.70 dB, +14 % bytes (Scaffold-GS without deformation, before compression)"
    paper["factorised_flat"] = "+25 % bytes (the INR prior saves 20 %; its factorised prior is one density a type)"
}

function name_family(f, name, members,    n, w, i) {
    family_name[f] = name
    n = split(members, w, " ")
    for (i = 1; i <= n; i++)
        family_of[w[i]] = f
}

function variant_section(    k, s) {
    say("")
    say("## One thing changed")
    say("")
    say("Each variant is trained by itself and measured on its own file. *Rate at equal PSNR* and *PSNR at equal bytes* are against the curve of")
    say("the whole method at four λ, by interpolation on straight lines between its points, logarithm of bytes over PSNR; \"-\" where that curve")
    say("does not reach. *Nearest*: the point of the whole method nearest in PSNR, and the differences to it. *BD-rate*: mean rate change over")
    say("the PSNR that both curves share. With four points each: Bjontegaard's cubics; with fewer, marked \"lines\": exact on straight lines,")
    say("both curves through the same λ, for a straight line between far points lies below a bent curve. Bold lines are means over the variant's")
    say("runs. Positive rates and negative PSNR: the variant is worse. *Paper*: its table of ablations, Neu3D at its highest rate, same λ.")
    say("*Within seeds*: the difference in PSNR at equal bytes is less than the spread of three seeds of the whole method on that scene. *factorised_flat* is")
    say("one Gaussian a component for all anchors, *factorised* the same with the autoregression kept; *inr* has layers as wide as those of the whole method's")
    say("F_deform, *inr_paper* as many and as wide as the paper's; *hardmask* pushes the temporal mask ten times as hard, *moremask* the offset mask three times; *recipe* leaves out what")
    say("the paper does not have: sprouts, seeded transients and the probe. Only the rows *_auto* have the choice of capacity; they are compared with the whole")
    say("method with that choice, *whole_auto*, and the rows *factorised_..._moremask* with *moremask*. *factorised_long* and *whole_long* are trained for all steps of preset fast, 18,000 and 10,000, the other rows for")
    say("a third of them.")
    for (k = 1; k <= n_scenes; k++) {
        s = scenes[k]
        if (has_variants(s)) {
            variant_table(s)
            variant_chart(s)
        }
    }
    variant_overview()
    variant_bars("kitchen")
}

function has_variants(s,    j) {
    for (j = 1; j <= n_variants; j++)
        if (wants(s, variants[j], "variant"))
            return 1
    return 0
}

function variant_table(s,    j) {
    say("")
    say("### Variants on " s)
    table("run,changed,λ,PSNR dB,bytes,rate at equal PSNR,PSNR at equal bytes,nearest,BD-rate,paper,verdict")
    for (j = 1; j <= n_variants; j++)
        if (wants(s, variants[j], "variant"))
            variant_rows(s, variants[j])
}

function variant_rows(s, v,    i, t, c) {
    for (i = 1; i <= n_runs[s, v]; i++) {
        t = runs[s, v, i]
        if (has(t))
            row(name_of(t) "|`" own_options(t) "`|" lambda[t] "|" values(t, "psnr:2 bytes") "|" signed(rate_change(t), 1, " %") "|" \
                signed(psnr_change(t), 2, " dB") "|" near_text(t))
        else
            row_missing(t "|`" own_options(t) "`|" lambda[t])
    }
    compare(s, v, c)
    if (c["runs"] > 0)
        row("**" v "**|||||" signed(c["rate"], 1, " %") "|" signed(c["psnr"], 2, " dB") "|" near_words(c) "|" \
            signed(bd_rate(c), 1, " %") bd_way(c) "|" (v in paper ? paper[v] : "") "|" \
            variant_verdict(v, c["worse"]) (within_seeds(s, c) ? "; within seeds" : ""))
}

function near_text(t,    u, c) {
    u = nearest(t)
    if (u == "")
        return "-"
    c["near_psnr"] = get(t, "psnr") - get(u, "psnr")
    c["near_rate"] = 100 * (get(t, "bytes") / get(u, "bytes") - 1)
    return u ": " near_words(c)
}

function near_words(c) { return signed(c["near_psnr"], 2, " dB") ", " signed(c["near_rate"], 1, " %") }

# Is the difference to the whole method no more than what seeds alone make? 0 where the seeds were not run, or the curve does not reach.
function within_seeds(s, c,    spread) {
    return c["psnr"] != "" && seed_spread(s, spread) && size_of(c["psnr"]) < spread["psnr"]
}

function variant_verdict(v, worse) {
    if (worse == "")
        return "cannot be said"
    return (worse ? "worse" : "better") (v in paper ? worse ? ", as in the paper" : ", **unlike the paper**: see the notes" : "")
}

# Options that a run has and the whole method on its scene has not.
function own_options(t,    w, n, i, text, base, part) {
    base = " " options[runs[scene[t], "whole", 1]] " "
    n = split(options[t], w, " ")
    for (i = 1; i <= n; i++) {
        part = w[i]
        if (w[i] ~ /^--(set|preset|lambda|seed|downscale|capacity)$/)
            part = w[i] " " w[++i]
        if (part !~ /^--lambda/ && index(base, " " part " ") == 0)
            text = join(text, " ", part)
    }
    return text
}

# ---- charts ----

# Variants that no family names are of the last one.
function family(v) { return v in family_of ? family_of[v] : N_FAMILIES }

# How many of a scene's variants of a family there are, and in any["rows"] how many of their rows.
function count_family(s, f, any,    j, n) {
    for (j = 1; j <= n_variants; j++)
        if (family(variants[j]) == f && wants(s, variants[j], "variant")) {
            n++
            any["rows"] += count_runs(s, variants[j])
        }
    return n + 0
}

# A panel a family that the scene has, two beside each other, each with the whole method's curve.
function variant_chart(s,    f, n, k, list, any) {
    for (f = 1; f <= N_FAMILIES; f++)
        if (count_family(s, f, any) > 0)
            list[++n] = f
    if (any["rows"] > 0) {
        chart_open("variants-" s, 900, int((n + 1) / 2) * 342 + 4, "PSNR over bytes of the variants on " s)
        for (k = 1; k <= n; k++)
            variant_panel(s, list[k], (k - 1) % 2 * 450, int((k - 1) / 2) * 342 + 4)
        svg_close()
    }
    show_chart("variants-" s, "PSNR over bytes of the variants on " s "; the axes differ")
}

function variant_panel(s, f, left, top,    j, k, v) {
    plot_begin()
    plot_curve(s, "whole", "whole", colours[1], "circle", "", 0)
    k = 1
    for (j = 1; j <= n_variants; j++) {
        v = variants[j]
        if (family(v) == f && wants(s, v, "variant")) {
            k = k % 8 + 1
            plot_curve(s, v, v, colours[k], markers[k], "6 4", 0)
        }
    }
    plot_draw(left, top, 450, 336, family_name[f], "size of the file, kB (1000 bytes)", "PSNR, dB", "", 1)
}

# All variants at a glance: rate at equal PSNR and PSNR at equal bytes.
function variant_overview(    j, v, any) {
    any = 0
    dots_begin()
    for (j = 1; j <= n_variants; j++) {
        v = variants[j]
        if (is_variant(v)) {
            dots_row(v)
            any += variant_dots(v)
        }
    }
    if (any) {
        chart_open("variants", 900, dots_height() + 96, "Variants against the whole method")
        dots_legend(180, 14)
        dots_draw(170, 40, 340, 1, "rate at equal PSNR, % (right: worse)", 1)
        dots_draw(530, 40, 360, 2, "PSNR at equal bytes, dB (left: worse)", 0)
        svg_close()
    }
    say("")
    say("### All variants")
    show_chart("variants", "Variants against the whole method, by scene")
}

function is_variant(v,    k) {
    for (k = 1; k <= n_scenes; k++)
        if (wants(scenes[k], v, "variant"))
            return 1
    return 0
}

# Panel 1: rate, panel 2: PSNR. How many scenes had runs.
function variant_dots(v,    k, s, c, any, rates, psnrs) {
    for (k = 1; k <= n_scenes; k++) {
        s = scenes[k]
        if (!wants(s, v, "variant"))
            continue
        compare(s, v, c)
        dots_value(1, one_rate(c), s)
        dots_value(2, c["psnr"], s)
        any += c["runs"] > 0
        rates += one_rate(c) != ""
        psnrs += c["psnr"] != ""
    }
    if (!rates)
        dots_word(1, any ? "the curve does not reach" : "not run yet")
    if (!psnrs)
        dots_word(2, any ? "the curve does not reach" : "not run yet")
    return any + 0
}

# ---- bars ----

function variant_bars(s) {
    variant_bar(s, "concat", "bank against concat", "bank better")
    variant_bar(s, "inr_paper", "bank against inr, a network as large as the paper's (8 layers of 256)", "bank better")
    slow_variant_bar(s, "inr_paper", "the same, the bank trained as long as preset fast does, which takes less time", "bank better")
    variant_bar(s, "inr", "bank against inr, layers as wide as F_deform's (the paper has no such row)", "bank better")
    variant_bar(s, "factorised_flat", "inr prior against factorised prior, components independent as in the paper's", "factorised costs at least 10 % more rate")
    variant_bar(s, "factorised_flat_auto", "the same, both with the choice of capacity, as by default", "factorised costs at least 10 % more rate")
    variant_bar(s, "factorised", "inr prior against factorised prior that keeps the autoregression (the paper has no such row)", "factorised costs at least 10 % more rate")
    variant_bar(s, "factorised_auto", "the same with autoregression, both with the choice of capacity, as by default", "factorised costs at least 10 % more rate")
    variant_bar(s, "factorised_long", "the same with autoregression, both trained as long as preset fast does", "factorised costs at least 10 % more rate")
    variant_bar(s, "noactive", "no activation", "costs rate or quality")
    variant_bar(s, "noprogress", "no progressive training", "costs quality")
    variant_bar(s, "static", "no deformation, nor activation, as in the paper's row", "far worse (here: at least 1 dB)")
    variant_bar(s, "nomotion", "no deformation, all else kept (the paper has no such row)", "worse")
    recipe_bars(s)
}

function variant_bar(s, v, what, limit,    c, rate, ok, how) {
    compare(s, v, c)
    how = sweep("'" s "-" v "-*' '" s "-" base_of(v) "-*'")
    if (c["runs"] == 0 || c["runs"] < n_runs[s, v] || count_runs(s, base_of(v)) < n_runs[s, base_of(v)]) {
        bar(1, s ": " what, limit, "", "", how)
        return
    }
    rate = one_rate(c)
    ok = c["worse"] == "" ? "?" : c["worse"]
    if (v ~ /^factorised/)
        ok = rate == "" ? (c["near_psnr"] <= 0 ? c["near_rate"] >= 10 : "?") : rate >= 10
    if (v == "static")
        ok = (c["psnr"] != "" ? c["psnr"] : c["near_psnr"]) <= -1
    # Another prior begins where the whole method's stage 1 ends: seeds do not come between.
    if (v !~ /^factorised/ && within_seeds(s, c))
        ok = seeded_verdict(s, v)
    bar(1, s ": " what, limit, "`" own_options(runs[s, v, 1]) "`: rate at equal PSNR " signed(rate, 1, " %") ", PSNR at equal bytes " \
        signed(c["psnr"], 2, " dB") "; nearest " near_words(c) mark_of(tags_of(s, v) " " tags_of(s, base_of(v))) \
        (within_seeds(s, c) ? "; within seeds" : "") seeded_words(s, v), ok, how)
}

# For a variant whose steps take much longer: against the whole method at the preset's full length, with the core minutes of training of the largest files of both.
function slow_variant_bar(s, v, what, limit,    ours, its) {
    its = get(runs[s, v, 1], "cpu_s")
    ours = get(runs[s, "whole_long", 1], "cpu_s")
    against = "whole_long"
    variant_bar(s, v, what " (" fixed(ours == "" ? "" : ours / 60, 0) " against " fixed(its == "" ? "" : its / 60, 0) " core minutes)", limit)
    against = ""
}
