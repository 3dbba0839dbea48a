"""Scales: from numbers to pixels, and where their ticks are.
SPDX-License-Identifier: BSD-2-Clause"""
import math

ROOM_X, ROOM_Y = 0.07, 0.11     # beyond the data; more of y, so that notes below points fit


class Axis:
    """Shows low to high, and a little more of either, between the pixels start and end. log:
    logarithmic (both above 0). zero: begins at 0. room: share of the range that is added."""

    def __init__(self, low, high, start, end, room=ROOM_X, log=False, zero=False):
        self.start, self.end, self.log = start, end, log
        if log:
            more = math.exp(math.log(high / low) * 0.06) if high > low else 1.5
            self.low, self.high = math.log(low / more), math.log(high * more)
            return
        if high <= low:
            more = 1 if low == 0 else abs(low) * 0.02
            low, high = low - more, high + more
        more = (high - low) * room
        self.low = 0 if zero else low - more
        self.high = high + more

    def at(self, value):
        if self.log:
            value = math.log(value)
        return self.start + (self.end - self.start) * (value - self.low) / (self.high - self.low)

    def ticks(self, most):
        """(value, text) of about that many ticks."""
        low, high = self.low, self.high
        if self.log:
            low, high = math.exp(low), math.exp(high)
            if high / low > 6:
                return log_ticks(low, high, most)
        step = step_of(high - low, most)
        digits = 0 if step >= 0.999 else int(0.999 - math.log(step) / math.log(10))
        first = -math.floor(-low / step + 1e-6)
        last = math.floor(high / step + 1e-6)
        return [(i * step, number_text(i * step, digits)) for i in range(first, last + 1)]


def step_of(span, most):
    """The 1, 2 or 5 times a power of ten that divides a span into at most so many parts."""
    power = math.exp(math.log(10) * math.floor(math.log(span / most) / math.log(10) + 1e-9))
    unit = span / most / power
    return power * (1 if unit <= 1.0001 else 2 if unit <= 2.0001 else 5 if unit <= 5.0001 else 10)


def log_ticks(low, high, most):
    """1, 2, 5 of each decade; 1 alone where these would be too many."""
    parts = (1,) if math.log(high / low) / math.log(10) * 3 > most else (1, 2, 5)
    found = []
    for decade in range(math.floor(math.log(low) / math.log(10)),
                        math.floor(math.log(high) / math.log(10)) + 1):
        for part in parts:
            value = part * math.exp(math.log(10) * decade)
            if low * 0.9999 <= value <= high * 1.0001:
                found.append((value, number_text(value, max(0, -decade))))
    return found


def number_text(value, digits):
    """With thousands apart, and no minus before a zero."""
    text = f"{abs(value):.{digits}f}"
    sign = "−" if value < 0 and float(text) != 0 else ""
    if digits == 0 and value >= 9999.5:
        text = f"{int(text):,}".replace(",", " ")
    return sign + text


def area(svg, left, top, width, height, x, y, x_ticks=None):
    """Lines and numbers of both axes around and across an area."""
    svg.box(left, top, width, height, "#fbfbfb")
    y_ticks(svg, left, width, y, 6 if height > 160 else 4)
    for value, text in x_ticks or x.ticks(9 if width > 500 else 6):
        at = x.at(value)
        svg.line(at, top, at, top + height, "#e8e8e8")
        svg.write(at, top + height + 17, text, "middle", 12, "#444444")
    frame(svg, left, top, width, height)


def y_ticks(svg, left, width, y, most=6):
    for value, text in y.ticks(most):
        at = y.at(value)
        svg.line(left, at, left + width, at, "#dddddd")
        svg.write(left - 7, at + 4, text, "end", 12, "#444444")


def frame(svg, left, top, width, height):
    svg.line(left, top + height, left + width, top + height, "#444444")
    svg.line(left, top, left, top + height, "#444444")


def labels(svg, left, top, width, height, x_label, y_label):
    svg.write(left + width / 2, top + height + 36, x_label, "middle", 12.5)
    svg.write(left - 46, top + height / 2, y_label, "middle", 12.5, up=True)
