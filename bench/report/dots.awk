# dots.awk - panels of dots over one number, a named row each, a marker each scene. Used by bench/report.sh.
#     dots_begin(); dots_row(name); dots_value(panel, v, scene); dots_word(panel, text); ...; dots_draw(left, top, width, panel, label, names)
# SPDX-License-Identifier: BSD-2-Clause

function dots_begin() {
    dots_rows = 0
    split("", dots_n)
    split("", dots_text)
}

function dots_row(name) { dots_name[++dots_rows] = name }

# Into the last row.
function dots_value(panel, v, s,    i) {
    if (v == "")
        return
    i = ++dots_n[panel]
    dots_v[panel, i] = v + 0
    dots_at[panel, i] = dots_rows
    dots_scene[panel, i] = s
}

# Words in the last row of a panel, where there is nothing to mark.
function dots_word(panel, text) { dots_text[panel, dots_rows] = text }

function dots_height() { return dots_rows * 24 + 8 }

# Of scenes that occur anywhere, in a line; those without a curve share one look.
function dots_legend(left, y,    k, i, p, s, found) {
    for (p = 1; p <= 2; p++)
        for (i = 1; i <= dots_n[p]; i++)
            found[scene_marker(dots_scene[p, i])] = 1
    for (k = 1; k <= n_curve_scenes; k++) {
        s = curve_scenes[k]
        if (scene_marker(s) in found)
            left = dots_legend_entry(left, y, s, s)
    }
    if ("cross" in found)
        dots_legend_entry(left, y, "", "other scenes")
}

function dots_legend_entry(left, y, s, text) {
    svg_marker(scene_marker(s), left, y, 5, scene_colour(s))
    svg_write(left + 11, y + 4, text, "start", 12, "#222222")
    return left + 44 + svg_width(text, 12)
}

# names: written left of the panel. The area lies below top; 0 is always shown, by a darker line. dots_band > 0: what is that near to 0 is set off.
function dots_draw(left, top, width, panel, label, names,    i, y, low, high, height, n, tick, tick_text, x) {
    height = dots_height()
    svg_box(left, top, width, height, "#fbfbfb")
    for (i = 1; i <= dots_n[panel]; i++) {
        low = dots_v[panel, i] < low + 0 ? dots_v[panel, i] : low + 0
        high = dots_v[panel, i] > high + 0 ? dots_v[panel, i] : high + 0
    }
    if (dots_band > 0) {
        low = low < -dots_band ? low : -dots_band
        high = high > dots_band ? high : dots_band
    }
    axis_set("x", low + 0, high + 0, left, left + width, 0)
    if (dots_band > 0)
        svg_box(axis_at("x", -dots_band), top, axis_at("x", dots_band) - axis_at("x", -dots_band), height, "#dff1e8")
    for (i = 1; i <= dots_rows; i++) {
        y = top + 4 + (i - 0.5) * 24
        svg_line(left, y, left + width, y, "#e8e8e8", 1)
        if (names)
            svg_write(left - 9, y + 4, dots_name[i], "end", 12, "#222222")
        if ((panel, i) in dots_text)
            svg_write(left + width / 2, y + 4, dots_text[panel, i], "middle", 11, "#777777")
    }
    n = axis_ticks("x", 6, tick, tick_text)
    for (i = 1; i <= n; i++) {
        x = axis_at("x", tick[i])
        svg_line(x, top, x, top + height, tick[i] == 0 ? "#444444" : "#e0e0e0", 1)
        svg_write(x, top + height + 17, tick_text[i], "middle", 12, "#444444")
    }
    svg_line(left, top + height, left + width, top + height, "#444444", 1)
    svg_write(left + width / 2, top + height + 38, label, "middle", 12.5, "#222222")
    for (i = 1; i <= dots_n[panel]; i++)
        dots_mark(panel, i, top)
}

function dots_mark(panel, i, top,    s, y) {
    s = dots_scene[panel, i]
    y = top + 4 + (dots_at[panel, i] - 0.5) * 24 + dots_shift(s)
    svg_marker(scene_marker(s), axis_at("x", dots_v[panel, i]), y, 5, scene_colour(s))
}

# Scenes lie beside each other in a row, so that none hides another.
function dots_shift(s,    k) {
    for (k = 1; k <= n_curve_scenes; k++)
        if (curve_scenes[k] == s)
            return (k - (n_curve_scenes + 1) / 2) * 2.6
    return 0
}
