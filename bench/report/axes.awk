# axes.awk - scales: from numbers to pixels, and where their ticks are. Axes have names, "x" and "y". Used by bench/report.sh.
# SPDX-License-Identifier: BSD-2-Clause

# The axis shows low to high, a little more of either (of y so much that notes below points fit), between the pixels from and to. is_log:
# logarithmic (both above 0). zero: begins at 0.
function axis_set(a, low, high, from, to, is_log, zero,    room, step) {
    axis_log[a] = is_log
    axis_from[a] = from
    axis_to[a] = to
    if (is_log) {
        room = high > low ? exp(log(high / low) * 0.06) : 1.5
        axis_low[a] = log(low / room)
        axis_high[a] = log(high * room)
        return
    }
    if (high <= low) {
        room = low == 0 ? 1 : size_of(low) * 0.02
        low -= room
        high += room
    }
    room = (high - low) * (a == "y" ? 0.11 : 0.07)
    axis_low[a] = zero ? 0 : low - room
    axis_high[a] = high + room
}

function axis_at(a, v) {
    if (axis_log[a])
        v = log(v)
    return axis_from[a] + (axis_to[a] - axis_from[a]) * (v - axis_low[a]) / (axis_high[a] - axis_low[a])
}

# The 1, 2 or 5 times a power of ten that divides span into at most most parts.
function axis_step(span, most,    power, unit) {
    power = exp(log(10) * whole(log(span / most) / log(10) + 1e-9))
    unit = span / most / power
    return power * (unit <= 1.0001 ? 1 : unit <= 2.0001 ? 2 : unit <= 5.0001 ? 5 : 10)
}

# The greatest integer that is not above v.
function whole(v,    i) {
    i = int(v)
    return i > v ? i - 1 : i
}

# tick[1..n]: values; tick_text[1..n]: words. Returns n. most: about how many fit. given: these values, divided by spaces, as they are.
function axis_ticks(a, most, tick, tick_text, given,    n, low, high, step, i, digits, last) {
    if (given != "") {
        n = split(given, tick, " ")
        split(given, tick_text, " ")
        return n
    }
    low = axis_low[a]
    high = axis_high[a]
    if (axis_log[a]) {
        low = exp(low)
        high = exp(high)
        if (high / low > 6)
            return axis_log_ticks(low, high, most, tick, tick_text)
    }
    step = axis_step(high - low, most)
    digits = step >= 0.999 ? 0 : int(0.999 - log(step) / log(10))
    last = whole(high / step + 1e-6)
    for (i = -whole(-low / step + 1e-6); i <= last; i++) {
        tick[++n] = i * step
        tick_text[n] = axis_number(i * step, digits)
    }
    return n
}

# 1, 2, 5 of each decade; 1 alone where these would be too many.
function axis_log_ticks(low, high, most, tick, tick_text,    n, d, k, v, part, parts) {
    parts = split(log(high / low) / log(10) * 3 > most ? "1" : "1 2 5", part, " ")
    for (d = whole(log(low) / log(10)); d <= log(high) / log(10); d++)
        for (k = 1; k <= parts; k++) {
            v = part[k] * exp(log(10) * d)
            if (v < low * 0.9999 || v > high * 1.0001)
                continue
            tick[++n] = v
            tick_text[n] = axis_number(v, d < 0 ? -d : 0)
        }
    return n
}

# Thousands apart; no minus before a zero.
function axis_number(v, digits,    text, sign, rest) {
    text = sprintf("%." digits "f", size_of(v) + 0)
    sign = v < 0 && text + 0 != 0 ? "−" : ""
    if (digits == 0 && v >= 9999.5) {
        for (rest = ""; length(text) > 3; text = substr(text, 1, length(text) - 3))
            rest = " " substr(text, length(text) - 2) rest
        text = text rest
    }
    return sign text
}

# Lines and numbers of both axes around and across the area; labels may be empty. x_given: ticks of x, as for axis_ticks.
function axis_draw(left, top, width, height, x_label, y_label, x_given,    n, i, at, tick, tick_text) {
    svg_box(left, top, width, height, "#fbfbfb")
    n = axis_ticks("y", height > 160 ? 6 : 4, tick, tick_text)
    for (i = 1; i <= n; i++) {
        at = axis_at("y", tick[i])
        svg_line(left, at, left + width, at, "#dddddd", 1)
        svg_write(left - 7, at + 4, tick_text[i], "end", 12, "#444444")
    }
    n = axis_ticks("x", width > 500 ? 9 : 6, tick, tick_text, x_given)
    for (i = 1; i <= n; i++) {
        at = axis_at("x", tick[i])
        svg_line(at, top, at, top + height, "#e8e8e8", 1)
        svg_write(at, top + height + 17, tick_text[i], "middle", 12, "#444444")
    }
    svg_line(left, top + height, left + width, top + height, "#444444", 1)
    svg_line(left, top, left, top + height, "#444444", 1)
    axis_labels(left, top, width, height, x_label, y_label)
}

function axis_labels(left, top, width, height, x_label, y_label) {
    svg_write(left + width / 2, top + height + 36, x_label, "middle", 12.5, "#222222")
    svg_write(left - 46, top + height / 2, y_label, "middle", 12.5, "#222222", 0, 1)
}
