# page.awk - puts the page together, bench/report.md, on stdout. Used by bench/report.sh, with -v
#     results: folder of sweep.csv, logs and charts      charts: where charts go      pages: folder of raster.md and the others      notes: page of notes
# SPDX-License-Identifier: BSD-2-Clause

function chart_open(name, width, height, title) {
    drawn[name] = 1
    svg_open(charts "/" name ".svg", width, height, title)
}

END {
    if (failed)
        exit 1
    for (k = 1; k <= n_scenes; k++)
        if (has_curve(scenes[k]))
            curve_scenes[++n_curve_scenes] = scenes[k]
    rate_section()
    variant_section()
    medium_section()
    tint_section()
    still_section()
    speed_section()
    bytes_section()
    span_section()
    estimate_section()
    kept_section()
    precision_section()
    seed_section()
    seeded_section()
    recipe_section()
    log_section()
    sheet_section()
    command_section()
    page_print()
}

function page_print(    i, n, line) {
    print "# What the method shows"
    print ""
    print "Written by `make report` from [sweep.csv](sweep.csv) and the pages below; `make sweep` makes the rows. " count_there() " of " n_tags \
        " wanted runs are there" (count_old() ? ", " count_old() " of them older than the sources (†)" : "") "."
    print "The bars are those of the method, by number; \"not run yet\" stands wherever a run is missing."
    print "Bars: " n_verdicts["met"] + 0 " met, " n_verdicts["**missed**"] + 0 " missed, " n_verdicts["not run yet"] + 0 " not run yet" \
        (n_verdicts["cannot be said"] ? ", " n_verdicts["cannot be said"] " that cannot be said" : "") "."
    print ""
    print "| # | what | bar | measured | verdict | command, then `make report` |"
    print "|---|---|---|---|---|---|"
    for (i = 1; i <= n_bars; i++)
        print bars[i]
    print ""
    print "## Notes"
    print ""
    n = 0
    while ((getline line <notes) > 0) {
        print line
        n++
    }
    if (n == 0)
        print "None yet."
    print ""
    for (i = 1; i <= n_body; i++)
        print body[i]
}

function count_there(    i, n) {
    for (i = 1; i <= n_tags; i++)
        n += has(tag[i])
    return n + 0
}
function count_old(    i, n) {
    for (i = 1; i <= n_tags; i++)
        n += is_old(tag[i])
    return n + 0
}

# Runs that keep a picture.
function sheet_section(    i, t) {
    say("")
    say("## Pictures")
    say("")
    say("Sheets of truth, ours and error (5 times) at three times, of pictures that training never saw, drawn from the decoded file.")
    table("sheet,changed,PSNR dB,SSIM,MS-SSIM,bytes,training s,jobs x threads,anchors,moving,decode ms")
    for (i = 1; i <= n_tags; i++) {
        t = tag[i]
        if (!keeps(t, "sheet"))
            continue
        if (has(t))
            row("[" name_of(t) "](sheets/" t ".jpg)|" sheet_options(t) "|" values(t, "psnr:2 ssim:4 ms_ssim:4 bytes train_s:0 team anchors dynamic " \
                "decode_ms:0"))
        else
            row_missing(t "|" sheet_options(t))
    }
}

function sheet_options(t,    text) {
    text = own_options(t)
    return text == "" ? "" : "`" text "`"
}

# Options: those that made the row, wanted ones where there is none.
function command_of(t) { return "`ted4enc " (where[t] ~ /^own:/ ? "" : "$TED4_DATA/") where[t] " " (has(t) ? get(t, "options") : options[t]) "`" }

function command_section(    i, t) {
    say("")
    say("## Commands")
    say("")
    say("`make sweep` runs what is missing, `bench/sweep.sh PATTERN...` parts of it, `make report` writes this page. A run by hand: its command")
    say("with `-o FILE.ted4`, then `ted4eval FILE.ted4 SCENE --downscale N`, `ted4info FILE.ted4 --budget`, `bench/spans FILE.ted4`,")
    say("`bench/rate_check FILE.ted4`. Scenes `own:NAME` are made by `ted4scene NAME -o FOLDER`.")
    say("† marks rows that older sources made, and numbers that depend on one. [sweep.csv](sweep.csv) has all columns." \
        (strangers ? " It holds " strangers " rows that sweep.txt no longer wants; they are not shown." : "") \
        (others ? " It holds " others " rows that other options than the wanted ones made; they count as not run." : ""))
    table("run,command,jobs x threads,key")
    for (i = 1; i <= n_tags; i++) {
        t = tag[i]
        if (has(t))
            row(name_of(t) "|" command_of(t) "|" values(t, "team key"))
        else
            row_missing(t "|" command_of(t))
    }
}
