# marks.awk - a chart of one column of the table: a row a scene, a marker a variant at its mean over seeds, and a line from the least to the most of them.
# SPDX-License-Identifier: BSD-2-Clause

# Colours are those of Okabe and Ito, which colour-blind readers can tell apart; markers differ too.
BEGIN {
    split("#000000 #d55e00 #0072b2 #009e73 #cc79a7 #e69f00", mark_colour, " ")
    split("circle square triangle diamond down cross", mark_kind, " ")
}

# factor: what numbers are multiplied by. zero: the axis begins at 0. Nothing is drawn, and 0 given, where no number is there.
function marks_chart(name, title, label, column, factor, zero,    low, high, k, i, top, height) {
    for (k = 1; k <= n_scenes; k++)
        for (i = 1; i <= n_lab; i++) {
            low = smaller(low, least_of(scenes[k], lab[i], column))
            high = smaller(high, most_of(scenes[k], lab[i], column), 1)
        }
    if (low == "")
        return 0
    height = n_scenes * 30 + 8
    svg_open(charts "/" name ".svg", 860, height + 108, title)
    svg_write(130, 22, title, "start", 14, "#111111", 1)
    marks_legend(130, 42)
    top = 58
    axis_set("x", factor * low, factor * high, 130, 840, 0, zero)
    marks_area(top, height, label)
    for (k = 1; k <= n_scenes; k++)
        for (i = n_lab; i >= 1; i--)
            marks_put(scenes[k], i, column, factor, top + 4 + (k - 0.5) * 30 + (i - (n_lab + 1) / 2) * 4)
    svg_close()
    return 1
}

# The smaller of two numbers that may be "", or the larger.
function smaller(a, b, larger) {
    if (a == "" || b == "")
        return a == "" ? b : a
    return (larger ? b > a : b < a) ? b : a
}

function marks_legend(left, y,    i) {
    for (i = 1; i <= n_lab; i++) {
        svg_marker(mark_kind[i], left, y, 5, mark_colour[i])
        svg_write(left + 10, y + 4, lab[i], "start", 12, "#222222")
        left += 40 + svg_width(lab[i], 12)
    }
}

function marks_area(top, height, label,    k, i, n, x, y, tick, tick_text) {
    svg_box(130, top, 710, height, "#fbfbfb")
    for (k = 1; k <= n_scenes; k++) {
        y = top + 4 + (k - 0.5) * 30
        svg_write(121, y + 4, scenes[k], "end", 12, "#222222")
        svg_line(130, y + 15, 840, y + 15, "#e8e8e8", 1)
    }
    n = axis_ticks("x", 9, tick, tick_text)
    for (i = 1; i <= n; i++) {
        x = axis_at("x", tick[i])
        svg_line(x, top, x, top + height, "#e0e0e0", 1)
        svg_write(x, top + height + 17, tick_text[i], "middle", 12, "#444444")
    }
    svg_line(130, top + height, 840, top + height, "#444444", 1)
    svg_write(485, top + height + 40, label, "middle", 12.5, "#222222")
}

function marks_put(s, i, column, factor, y,    v) {
    v = lab[i]
    if (mean_of(s, v, column) == "")
        return
    svg_line(axis_at("x", factor * least_of(s, v, column)), y, axis_at("x", factor * most_of(s, v, column)), y, mark_colour[i], 1.6)
    svg_marker(mark_kind[i], axis_at("x", factor * mean_of(s, v, column)), y, 4.2, mark_colour[i])
}
