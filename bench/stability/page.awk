# page.awk - judges bars 1 to 3 of the lab and puts the page together, bench/stability.md, on stdout. Takes -v
#     charts: where charts go      notes: page of notes
# SPDX-License-Identifier: BSD-2-Clause

END {
    if (failed)
        exit 1
    # Variants of the lab, in the order of the table.
    for (i = 1; i <= n_variants; i++)
        for (k = 1; k <= n_scenes; k++)
            if (wants(scenes[k], variants[i], "lab")) {
                lab[++n_lab] = variants[i]
                break
            }
    read_notes()
    drawn_if("worst", marks_chart("worst", "Worst held-out frame", "PSNR dB", "worst", 1, 0))
    drawn_if("mean", marks_chart("mean", "Mean of held-out frames", "PSNR dB", "psnr", 1, 0))
    drawn_if("out", marks_chart("out", "Anchors thrown out of every picture", "% of drawn anchors", "out_share", 100, 1))
    quality_section()
    failure_section()
    out_section()
    numbers_section()
    strip_section()
    command_section()
    run_bars()
    come_bars()
    seed_bars()
    page_print()
}

function drawn_if(name, is) {
    if (is)
        drawn[name] = 1
}

function lab_command(patterns) { return "`bench/stability.sh" (patterns == "" ? "" : " " patterns) "`" }

# Does the variant have three rows on the scene?
function has_three(s, v) { return count_runs(s, v) >= 3 }

# 1: enough of it ran; the whole method does not break; what is weak is explained.
function run_bars(    k, i, whole_scenes, all, rows, wanted, breaks_whole, n_whole) {
    for (k = 1; k <= n_scenes; k++) {
        all = 1
        for (i = 1; i <= n_lab; i++) {
            all = all && has_three(scenes[k], lab[i])
            rows += count_runs(scenes[k], lab[i])
            wanted += n_runs[scenes[k], lab[i]]
        }
        whole_scenes += all
        n_whole += count_runs(scenes[k], "whole")
        breaks_whole += count_breaks(scenes[k], "whole", "crash") + count_breaks(scenes[k], "whole", "error") + \
            count_breaks(scenes[k], "whole", "nan") + count_breaks(scenes[k], "whole", "diverges")
    }
    bar(1, "what ran", "at least 16 scenes x 3 seeds x 6 variants", whole_scenes + 0 " scenes whole, with " n_lab " variants; " rows + 0 " of " wanted " rows", \
        whole_scenes >= 16 && n_lab >= 6 ? 1 : "", lab_command(""))
    bar(1, "whole method: crash, error, NaN, divergence", "none", breaks_whole + 0 " in " n_whole + 0 " runs", \
        breaks_whole > 0 ? 0 : whole_scenes >= 16 ? 1 : "", lab_command("'*-whole-*'"))
    bar(1, "weak spots of the whole method", "every one explained", n_failures + 0 " scenes, " n_unexplained + 0 " of them unexplained", \
        n_unexplained > 0 ? 0 : whole_scenes >= 16 ? 1 : "", "[notes](stability-notes.md)")
}

# 2: where things come, go or hide.
function come_bars(    k, s, gain, ok, how) {
    for (k = 1; k <= n_scenes; k++) {
        s = scenes[k]
        if (!in_group(runs[s, "whole", 1], "come"))
            continue
        how = lab_command("'" s "-whole-*' '" s "-noactive-*'")
        ok = has_three(s, "whole") && has_three(s, "noactive")
        gain = mean_of(s, "whole", "worst")
        if (gain != "")
            gain = mean_of(s, "noactive", "worst") == "" ? "" : gain - mean_of(s, "noactive", "worst")
        bar(2, s ": worst frame, whole method above no activation", "at least 1 dB", signed(gain, 2, " dB") any_old(s, "whole"), \
            ok && gain != "" ? gain >= 1 : "", how)
    }
    thrown_bar()
}

# 2: anchors that leave every picture, in these scenes together; where none does either way there is nothing to be fewer than.
function thrown_bar(    k, s, with, without, text, ok, all, more) {
    all = 1
    for (k = 1; k <= n_scenes; k++) {
        s = scenes[k]
        if (!in_group(runs[s, "whole", 1], "come"))
            continue
        all = all && has_three(s, "whole") && has_three(s, "noactive")
        if (!count_runs(s, "whole") || !count_runs(s, "noactive"))
            continue
        text = join(text, ", ", s " " fixed(mean_of(s, "whole", "out"), 1) " against " fixed(mean_of(s, "noactive", "out"), 1))
        more += mean_of(s, "whole", "out") > mean_of(s, "noactive", "out")
        with += mean_of(s, "whole", "out")
        without += mean_of(s, "noactive", "out")
    }
    bar(2, "anchors thrown out of view where things come, go or hide, means over seeds", "fewer than without activation, and in no scene more", text, \
        !all || text == "" ? "" : with + without == 0 ? "?" : with < without && !more, lab_command("'*-whole-*' '*-noactive-*'"))
}

# 3: seeds.
function seed_bars(    k, s, text, worst, all, n, t, u, same, n_same, n_again, n_told) {
    all = 1
    for (k = 1; k <= n_scenes; k++) {
        s = scenes[k]
        if (in_group(runs[s, "whole", 1], "easy")) {
            n++
            all = all && has_three(s, "whole")
            if (spread_of(s, "whole") != "") {
                text = join(text, "; ", s " " fixed(spread_of(s, "whole"), 2) " dB")
                worst = smaller(worst, spread_of(s, "whole"), 1)
            }
        }
        t = runs[s, "again", 1]
        u = runs[s, "whole", 1]
        if (t == "")
            continue
        n_again++
        if (!has(t) || !has(u) || is_old(t) || is_old(u))
            continue
        same = get(t, "hash") == get(u, "hash") && get(t, "bytes") == get(u, "bytes")
        n_same += same
        n_told++
    }
    bar(3, "spread of mean PSNR between seeds, easy scenes", "below 0.3 dB", text, \
        n == 0 || worst == "" ? "" : worst >= 0.3 ? 0 : all ? 1 : "", lab_command("easy"))
    bar(3, "the same seed trained twice", "the same bytes", n_told + 0 " of " n_again + 0 " scenes told, " n_same + 0 " equal in size and hash", \
        n_told > n_same ? 0 : n_again > 0 && n_told == n_again ? 1 : "", lab_command("again '*-whole-1'"))
}

function page_print(    i, there, old) {
    for (i = 1; i <= n_tags; i++) {
        there += has(tag[i])
        old += is_old(tag[i])
    }
    print "# The stability lab"
    print ""
    print "Written by `make stability` from [stability.csv](stability.csv): " there + 0 " of " n_tags " wanted runs are there" \
        (old ? ", " old " of them older than the sources (†)" : "") "."
    print "The bars are those of the lab, by number; \"not run yet\" stands wherever a run is missing."
    print "Bars: " n_verdicts["met"] + 0 " met, " n_verdicts["**missed**"] + 0 " missed, " n_verdicts["not run yet"] + 0 " not run yet" \
        (n_verdicts["cannot be said"] ? ", " n_verdicts["cannot be said"] " that cannot be said" : "") "."
    print ""
    print "| # | what | bar | measured | verdict | command, then `bench/stability_page.sh` |"
    print "|---|---|---|---|---|---|"
    for (i = 1; i <= n_bars; i++)
        print bars[i]
    for (i = 1; i <= n_body; i++)
        print body[i]
}
