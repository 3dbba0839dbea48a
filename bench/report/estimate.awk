# estimate.awk - the rate that training estimates against the bytes of the file: bar 7. Used by bench/report.sh.
# SPDX-License-Identifier: BSD-2-Clause

# Percent by which the estimate differs from the attributes' substreams; "" when not known.
function estimate_error(t) {
    return !has(t) || payload(t) <= 0 || get(t, "estimated_bits") == "" ? "" : 100 * (get(t, "estimated_bits") / (8 * payload(t)) - 1)
}

function estimate_section(    k, i, v, n, e, worst, at, all, missing, tags) {
    say("")
    say("## Rate estimated in training against the file")
    say("")
    say("`estimated_bits` of `ted4enc --json`, the trainer's formula on rounded symbols of all anchors, against the bytes of the attributes'")
    say("substreams in the file. Of each variant's runs the one with the largest difference.")
    table("variant,runs,estimated against file,of run")
    all = ""
    dots_begin()
    for (k = 1; k <= n_variants; k++) {
        v = variants[k]
        dots_row(v)
        n = 0
        for (i = 1; i <= n_tags; i++) {
            if (variant[tag[i]] != v || (e = estimate_error(tag[i])) == "")
                continue
            dots_value(1, e, scene[tag[i]])
            tags = tags " " tag[i]
            if (n++ == 0 || size_of(e) > size_of(worst)) {
                worst = e
                at = tag[i]
            }
        }
        if (n == 0) {
            missing++
            row_missing(v)
            continue
        }
        row(v "|" n "|" signed(worst, 2, " %") "|" name_of(at))
        if (all == "" || size_of(worst) > size_of(all))
            all = worst
    }
    estimate_chart(all != "")
    bar(7, "rate estimated in training against the file, every variant", "within 1 %", all == "" ? "" : "at most " signed(all, 2, " %") " in " \
        n_variants - missing " of " n_variants " variants" mark_of(tags), all == "" ? "" : size_of(all) > 1 ? 0 : missing ? "" : 1, sweep(""))
}

function estimate_chart(any) {
    if (any) {
        chart_open("estimate", 900, dots_height() + 96, "Estimated rate against the file")
        dots_legend(190, 16)
        dots_band = 1
        dots_draw(190, 40, 670, 1, "estimated bits against those in the file, % (green: the bar)", 1)
        dots_band = 0
        svg_close()
    }
    show_chart("estimate", "Estimated rate against the file, a mark a run")
}
