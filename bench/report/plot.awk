# plot.awk - a panel of points over two axes, in series joined by lines, with a legend above the data. Used by bench/report.sh.
#     plot_begin(); plot_series(name, colour, marker, dash); plot_point(x, y, note); ...; plot_draw(...)
# plot_ticks: where x has ticks, "" chosen. plot_above: notes of what is added stand above their points.
# Colours are those of Okabe and Ito, which colour-blind readers can tell apart; markers differ too.
# SPDX-License-Identifier: BSD-2-Clause

BEGIN {
    split("#000000 #0072b2 #d55e00 #009e73 #cc79a7 #e69f00 #56b4e9 #666666", colours, " ")
    split("circle square triangle diamond down circle square triangle", markers, " ")
}

function plot_begin() {
    plot_n = 0
    plot_ticks = ""
    split("", plot_points)
}

# What follows belongs to it. dash: "" solid, "-" no line, else lengths.
function plot_series(name, colour, marker, dash) {
    plot_name[++plot_n] = name
    plot_colour[plot_n] = colour
    plot_marker[plot_n] = marker
    plot_dash[plot_n] = dash
    plot_points[plot_n] = 0
    plot_up[plot_n] = plot_above
}

# Ignored where one of the two is not known, or the axis cannot show it.
function plot_point(x, y, note,    i) {
    if (x == "" || y == "")
        return
    i = ++plot_points[plot_n]
    plot_x[plot_n, i] = x + 0
    plot_y[plot_n, i] = y + 0
    plot_note[plot_n, i] = note
}

function plot_is_empty(    s) {
    for (s = 1; s <= plot_n; s++)
        if (plot_points[s] > 0)
            return 0
    return 1
}

# Least and greatest x, y of all points, into range["x0"], ["x1"], ["y0"], ["y1"].
function plot_range(range,    s, i, first) {
    first = 1
    for (s = 1; s <= plot_n; s++)
        for (i = 1; i <= plot_points[s]; i++) {
            if (first || plot_x[s, i] < range["x0"]) range["x0"] = plot_x[s, i]
            if (first || plot_x[s, i] > range["x1"]) range["x1"] = plot_x[s, i]
            if (first || plot_y[s, i] < range["y0"]) range["y0"] = plot_y[s, i]
            if (first || plot_y[s, i] > range["y1"]) range["y1"] = plot_y[s, i]
            first = 0
        }
}

# Into the box left, top, width, height; scale: "" linear, or of x, y, xy logarithmic. legend: 0 none. Nothing is drawn for a panel without points but a word.
function plot_draw(left, top, width, height, title, x_label, y_label, scale, legend,    range, s) {
    svg_write(left + 62, top + 18, title, "start", 14, "#111111", 1)
    top += 28
    height -= 28
    if (legend) {
        s = plot_legend(left + 62, top, width - 62)
        top += s
        height -= s
    }
    left += 62
    width -= 78
    height -= 46
    if (plot_is_empty()) {
        svg_box(left, top, width, height, "#fbfbfb", "#dddddd")
        svg_write(left + width / 2, top + height / 2, "not run yet", "middle", 13, "#777777")
        return
    }
    plot_range(range)
    axis_set("x", range["x0"], range["x1"], left, left + width, index(scale, "x") > 0)
    axis_set("y", range["y0"], range["y1"], top + height, top, index(scale, "y") > 0)
    axis_draw(left, top, width, height, x_label, y_label, plot_ticks)
    for (s = plot_n; s >= 1; s--)
        plot_line(s)
    for (s = plot_n; s >= 1; s--)
        plot_marks(s)
}

function plot_line(s,    i, x, y) {
    if (plot_dash[s] == "-" || plot_points[s] < 2)
        return
    for (i = 1; i <= plot_points[s]; i++) {
        x[i] = axis_at("x", plot_x[s, i])
        y[i] = axis_at("y", plot_y[s, i])
    }
    svg_polyline(plot_points[s], x, y, plot_colour[s], 2, plot_dash[s])
}

# Notes stand below and right of a point: rate-distortion curves bend the other way; below it, to the left, near the right edge.
function plot_marks(s,    i, x, y, far) {
    for (i = 1; i <= plot_points[s]; i++) {
        x = axis_at("x", plot_x[s, i])
        y = axis_at("y", plot_y[s, i])
        svg_marker(plot_marker[s], x, y, 4.6, plot_colour[s])
        if (plot_note[s, i] == "")
            continue
        far = x + 10 + svg_width(plot_note[s, i], 11) > axis_to["x"]
        svg_note(far ? x + 12 : x + 7, plot_up[s] ? y - 8 : far ? y + 19 : y + 15, plot_note[s, i], far ? "end" : "start", "#333333")
    }
}

# Names of the series in rows that fit; returns the height. Series without points are left out.
function plot_legend(left, top, width,    s, x, y, w) {
    x = left
    y = top + 6
    for (s = 1; s <= plot_n; s++) {
        if (plot_points[s] == 0 || plot_name[s] == "")
            continue
        w = svg_width(plot_name[s], 12) + 42
        if (x > left && x + w > left + width) {
            x = left
            y += 18
        }
        if (plot_dash[s] != "-")
            svg_line(x, y, x + 24, y, plot_colour[s], 2, plot_dash[s])
        svg_marker(plot_marker[s], x + 12, y, 4.6, plot_colour[s])
        svg_write(x + 29, y + 4, plot_name[s], "start", 12, "#222222")
        x += w
    }
    return y - top + 16
}

# The look of a scene in every chart; those without a curve share one.
function scene_colour(s,    i) {
    for (i = 1; i <= n_curve_scenes; i++)
        if (curve_scenes[i] == s)
            return colours[i + 1]
    return "#666666"
}
function scene_marker(s,    i) {
    for (i = 1; i <= n_curve_scenes; i++)
        if (curve_scenes[i] == s)
            return markers[i]
    return "cross"
}
