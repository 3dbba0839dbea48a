# seeds.awk - the spread that the seed alone makes: bar 11. Used by bench/report.sh.
# SPDX-License-Identifier: BSD-2-Clause

# The whole method's run with seed j, and with how many seeds a scene wants it.
function whole_tag(s, j) { return s "-" (j == 1 ? "whole" : "seed" j) "-2" }
function seed_count(s,    n) {
    for (n = 1; wants(s, "seed" (n + 1), "seed"); n++)
        ;
    return n
}

function seed_section(    k, j, n, s, t, text, tags, spread) {
    say("")
    say("## Seeds")
    say("")
    say("The same command with seeds 1, 2, 3 and so on. Spread: greatest less least of the first three.")
    table("scene,run,PSNR dB,SSIM,bytes,anchors")
    for (k = 1; k <= n_scenes; k++) {
        s = scenes[k]
        n = seed_count(s)
        if (n == 1)
            continue
        for (j = 1; j <= n; j++) {
            t = whole_tag(s, j)
            tags = tags " " t
            if (has(t))
                row(s "|" name_of(t) "|" values(t, "psnr:3 ssim:4 bytes anchors"))
            else
                row_missing(s "|" t)
        }
        if (seed_spread(s, spread)) {
            row(s "|**spread**|" fixed(spread["psnr"], 3) "|" fixed(spread["ssim"], 4) "|" spread["bytes"] " (" fixed(spread["share"], 2) " %)|" \
                spread["anchors"])
            text = join(text, "; ", s ": " fixed(spread["psnr"], 3) " dB, " fixed(spread["share"], 2) " % of bytes")
        }
    }
    seed_chart()
    bar(11, "three seeds on one scene", "spread of PSNR and bytes reported", text == "" ? "" : text mark_of(tags), text == "" ? "" : 1, \
        sweep("seed kitchen-whole-2 fair-whole-2"))
}

# Greatest less least of seeds 1 to 3, by column, so that scenes with more of them compare; share: of the bytes, percent of the least. 0 when one is missing.
function seed_spread(s, spread,    j, c, t, n, name, low, high, v) {
    n = split("psnr ssim bytes anchors", name, " ")
    for (c = 1; c <= n; c++) {
        for (j = 1; j <= 3; j++) {
            t = whole_tag(s, j)
            if (!has(t))
                return 0
            v = get(t, name[c]) + 0
            low = j == 1 || v < low ? v : low
            high = j == 1 || v > high ? v : high
        }
        spread[name[c]] = high - low
        if (name[c] == "bytes")
            spread["share"] = 100 * (high / low - 1)
    }
    return 1
}

# A panel a scene: the seeds on top of the curve of the whole method, so that their spread is seen beside what λ does.
function seed_chart(    k, s, n, list, j, t, any) {
    any = 0
    for (k = 1; k <= n_scenes; k++)
        if (seed_count(scenes[k]) > 1) {
            list[++n] = scenes[k]
            any += count_runs(scenes[k], "seed2")
        }
    if (any) {
        chart_open("seeds", 900, int((n + 1) / 2) * 330 + 8, "Seeds beside the curve of the whole method")
        for (k = 1; k <= n; k++) {
            s = list[k]
            plot_begin()
            plot_series("other seeds", "#d55e00", "diamond", "-")
            for (j = 2; j <= seed_count(s); j++) {
                t = whole_tag(s, j)
                if (has(t))
                    plot_point(get(t, "bytes") / 1000, get(t, "psnr"), "")
            }
            plot_curve(s, "whole", "seed 1, four λ", "#0072b2", "circle", "", 1)
            plot_draw((k - 1) % 2 * 450, int((k - 1) / 2) * 330 + 4, 450, 322, s, "size of the file, kB (1000 bytes)", "PSNR, dB", "", 1)
        }
        svg_close()
    }
    show_chart("seeds", "Seeds at λ 0.002 beside what λ does")
}
