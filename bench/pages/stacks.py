"""Panels of stacked columns with one legend.
SPDX-License-Identifier: BSD-2-Clause"""
from . import axes
from .plot import LEGEND

# Tol's muted scheme, which colour-blind readers can tell apart. White edges keep neighbours apart,
# and the legend has the order of the columns.
MUTED = ("#332288 #88ccee #44aa99 #117733 #999933 #ddcc77 #cc6677 #882255 #aa4499 "
         "#bbbbbb").split()


class Stacks:
    """parts: names of the parts, from the bottom up."""

    def __init__(self, parts, colours=None):
        self.parts, self.colours, self.columns = parts, colours or MUTED, []

    def column(self, name, values):
        self.columns.append((name, values))

    def legend(self, svg, left, top):
        """Names from top to bottom, as in the columns."""
        for name, colour in reversed(list(zip(self.parts, self.colours))):
            svg.box(left, top, 14, 14, colour)
            svg.write(left + 21, top + 11.5, name)
            top += 22

    def draw(self, svg, left, top, width, height, title, x_label, y_label, share=False):
        """Into the box. share: values are percent, and written into the parts; else their sum
        stands above each column."""
        svg.write(left + LEGEND, top + 18, title, "start", 14, "#111111", bold=True)
        left, top, width, height = left + LEGEND, top + 40, width - 78, height - 86
        svg.box(left, top, width, height, "#fbfbfb")
        high = max(sum(values) for _, values in self.columns)
        y = axes.Axis(0, high, top + height, top, axes.ROOM_Y, zero=True)
        if share:
            y.high = high
        axes.y_ticks(svg, left, width, y)
        step = width / len(self.columns)
        for i, (name, values) in enumerate(self.columns):
            self.draw_column(svg, left + (i + 0.5) * step, step, y, values, share)
            svg.write(left + (i + 0.5) * step, top + height + 17, name, "middle", 12, "#444444")
        axes.frame(svg, left, top, width, height)
        axes.labels(svg, left, top, width, height, x_label, y_label)

    def draw_column(self, svg, x, step, y, values, share):
        below = 0
        for value, colour in zip(values, self.colours):
            low, high = y.at(below), y.at(below + value)
            below += value
            if value > 0:
                svg.box(x - step * 0.36, high, step * 0.72, low - high, colour, "#ffffff")
            if share and low - high >= 15:
                svg.note(x, (low + high) / 2 + 4, f"{value:.0f} %", "middle", "#111111")
        if not share:
            svg.write(x, y.at(below) - 6, axes.number_text(below, 0), "middle")
