# stacks.awk - panels of stacked columns with one legend. Used by bench/report.sh.
#     stacks_parts(names joined by |); stacks_begin(); stacks_column(name, values joined by space); stacks_draw(...)
# The colours are Tol's muted scheme, which colour-blind readers can tell apart; white edges keep neighbours apart, and the legend has the order of the columns.
# SPDX-License-Identifier: BSD-2-Clause

function stacks_parts(names) {
    stacks_n = split(names, stacks_name, "|")
    split("#332288 #88ccee #44aa99 #117733 #999933 #ddcc77 #cc6677 #882255 #aa4499 #bbbbbb", stacks_colour, " ")
}

function stacks_begin() { stacks_columns = 0 }

function stacks_column(name, parts,    i, v) {
    stacks_title[++stacks_columns] = name
    split(parts, v, " ")
    stacks_sum[stacks_columns] = 0
    for (i = 1; i <= stacks_n; i++) {
        stacks_v[stacks_columns, i] = v[i] + 0
        stacks_sum[stacks_columns] += v[i]
    }
}

# Names from top to bottom as in the columns.
function stacks_legend(left, top,    i) {
    for (i = stacks_n; i >= 1; i--) {
        svg_box(left, top, 14, 14, stacks_colour[i])
        svg_write(left + 21, top + 11.5, stacks_name[i], "start", 12, "#222222")
        top += 22
    }
}

# Into the box; total: digits of the sum above each column, "" none; share: number in the middle of each part, percent.
function stacks_draw(left, top, width, height, title, x_label, y_label, total, share,    i, j, n, high, y, y2, step, tick, tick_text, x, v) {
    svg_write(left + 62, top + 18, title, "start", 14, "#111111", 1)
    left += 62; top += 40; width -= 78; height -= 86
    for (i = 1; i <= stacks_columns; i++)
        high = stacks_sum[i] > high ? stacks_sum[i] : high
    svg_box(left, top, width, height, "#fbfbfb")
    axis_set("y", 0, high, top + height, top, 0, 1)
    if (share)
        axis_high["y"] = high
    n = axis_ticks("y", 6, tick, tick_text)
    for (i = 1; i <= n; i++) {
        y = axis_at("y", tick[i])
        svg_line(left, y, left + width, y, "#dddddd", 1)
        svg_write(left - 7, y + 4, tick_text[i], "end", 12, "#444444")
    }
    step = width / stacks_columns
    for (i = 1; i <= stacks_columns; i++) {
        x = left + (i - 0.5) * step
        v = 0
        for (j = 1; j <= stacks_n; j++) {
            y = axis_at("y", v)
            v += stacks_v[i, j]
            y2 = axis_at("y", v)
            if (stacks_v[i, j] > 0)
                svg_box(x - step * 0.36, y2, step * 0.72, y - y2, stacks_colour[j], "#ffffff")
            if (share && y - y2 >= 15)
                svg_note(x, (y + y2) / 2 + 4, sprintf("%.0f %%", stacks_v[i, j]), "middle", "#111111")
        }
        if (total != "")
            svg_write(x, axis_at("y", v) - 6, axis_number(v, total), "middle", 12, "#222222")
        svg_write(x, top + height + 17, stacks_title[i], "middle", 12, "#444444")
    }
    svg_line(left, top + height, left + width, top + height, "#444444", 1)
    svg_line(left, top, left, top + height, "#444444", 1)
    axis_labels(left, top, width, height, x_label, y_label)
}
