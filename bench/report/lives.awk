# lives.awk - how long anchors are active: bar 6. Used by bench/report.sh; numbers and pictures by bench/spans.
# SPDX-License-Identifier: BSD-2-Clause

# kitchen is the fast scene (a ball crosses it within a few frames), dog the slow one. What the paper's table shows by names of scenes is measured in the pictures
# of a camera that stands still: short lives belong where pixels change, and nowhere else.
function span_section(    i, t, slow, fast, ok, text) {
    say("")
    say("## How long anchors live")
    say("")
    say("Share of anchors by span a_f − a_s, by `bench/spans FILE.ted4 SCENE DOWNSCALE PICTURE.png`, whole method, λ 0.002. In the paper: Flame Steak")
    say("(slow) 3 / 0 / 97 %, Banana 9 / 6 / 85 %, Broom (fast) 18 / 35 / 47 %. *Light by short lives*: the share of what a pixel shows that comes from")
    say("anchors with a span up to 0.2, over all pictures of the held-out camera, if it stands still; a pixel has changed at a time when a channel is")
    say("more than 40 of 255 from its median over time.")
    table("run,up to 0.2,between,0.8 and more,activation in the file,pixels and times that have changed,light by short lives there,elsewhere")
    for (i = 1; i <= n_tags; i++)
        if (keeps(tag[i], "spans"))
            span_row(tag[i])
    span_chart()
    span_pictures()
    slow = "dog-whole-2"
    fast = "kitchen-whole-2"
    if (get(fast, "short_changed") != "" && get(slow, "span_short") != "") {
        ok = get(fast, "span_short") > get(slow, "span_short") && get(fast, "short_changed") >= 10 * get(fast, "short_same") && \
             exists(span_picture(fast)) && exists(span_picture(slow))
        text = "fast (kitchen): " span_text(fast) ", light by short lives " percent(fast, "short_changed") " where it changes, " \
               percent(fast, "short_same") " elsewhere; slow (dog): " span_text(slow) mark_of(slow " " fast)
    }
    bar(6, "activation spans up to 0.2 / between / 0.8 and more, and heat maps", \
        "short spans where things come and go (light by short lives at least ten times that elsewhere); more of them in the fast scene", text, ok, \
        sweep("kitchen-whole-2 dog-whole-2"))
}

function span_text(t) {
    return span_share(t, "short") " / " span_share(t, "between") " / " span_share(t, "long") " %"
}

function span_share(t, kind) { return fixed(100 * get(t, "span_" kind), 1) }

function percent(t, f) { return get(t, f) == "" ? "-" : fixed(100 * get(t, f), 1) " %" }

function span_row(t) {
    if (get(t, "span_short") == "")
        row_missing(name_of(t))
    else
        row(name_of(t) "|" span_share(t, "short") " %|" span_share(t, "between") " %|" span_share(t, "long") " %|" \
            (get(t, "activation") + 0 ? "yes" : "no: every span is 1") "|" percent(t, "changed") "|" percent(t, "short_changed") "|" \
            percent(t, "short_same"))
}

# Columns in order of what lives long; the paper's three beside ours.
function span_chart(    i, t, any) {
    stacks_parts("0.8 and more|between|up to 0.2")
    stacks_colour[1] = "#cccccc"; stacks_colour[2] = "#56b4e9"; stacks_colour[3] = "#d55e00"
    stacks_begin()
    any = 0
    for (i = 1; i <= n_tags; i++) {
        t = tag[i]
        if (keeps(t, "spans") && get(t, "span_short") != "") {
            stacks_column(scene[t], 100 * get(t, "span_long") " " 100 * get(t, "span_between") " " 100 * get(t, "span_short"))
            any++
        }
    }
    stacks_column("", "")
    stacks_column("Steak", "97 0 3")
    stacks_column("Banana", "85 6 9")
    stacks_column("Broom", "47 35 18")
    if (any) {
        chart_open("spans", 900, 348, "Share of anchors by activation span")
        stacks_draw(0, 4, 740, 340, "Share of anchors by activation span", \
            "ours by scene; right of the gap the paper's: Flame Steak (slow), Banana (medium), Broom (fast)", "share of anchors, %", "", 1)
        stacks_legend(752, 46)
        svg_close()
    }
    show_chart("spans", "Share of anchors by activation span")
}

function span_pictures(    i, t, any) {
    for (i = 1; i <= n_tags; i++) {
        t = tag[i]
        if (!keeps(t, "spans") || get(t, "span_short") == "" || !exists(span_picture(t)))
            continue
        if (any++ == 0) {
            say("")
            say("A held-out camera at the first, middle and last time; below, the same Gaussians in the colour of their anchor's span: blue 0,")
            say("white one half, red 1 (the strip is the scale), darker where the Gaussian is dark.")
        }
        say("")
        say("![Spans, " t "](charts/spans-" t ".jpg)")
    }
}

function span_picture(t) { return results "/charts/spans-" t ".jpg" }

function exists(file,    unused, found) {
    found = (getline unused <file) >= 0
    close(file)
    return found
}
