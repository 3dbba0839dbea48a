"""A chart of one column of the stability lab: a row for each scene, a marker for each variant at
its mean over seeds, and a line from the least to the most of them.
SPDX-License-Identifier: BSD-2-Clause"""
from .axes import Axis
from .svg import text_width

COLOURS = "#000000 #d55e00 #0072b2 #009e73 #cc79a7 #e69f00".split()
MARKERS = "circle square triangle diamond down cross".split()
LEFT, RIGHT, TOP, ROW = 130, 840, 58, 30    # pixels


def draw(lab, name, title, label, column, factor=1, zero=False):
    """factor: what numbers are multiplied by. zero: the axis begins at 0. Nothing is drawn where no
    number is there."""
    cells = [lab.cells(scene) for scene in lab.scenes]
    values = [value for row in cells for cell in row for value in cell.numbers(column)]
    if not values:
        return
    height = len(cells) * ROW + 8
    with lab.charts.open(name, 860, height + 108, title) as svg:
        svg.write(LEFT, 22, title, "start", 14, "#111111", bold=True)
        legend(svg, lab.variants)
        x = Axis(factor * min(values), factor * max(values), LEFT, RIGHT, zero=zero)
        area(svg, lab.scenes, x, height, label)
        middle = (len(lab.variants) - 1) / 2
        for k, row in enumerate(cells):
            for i, cell in reversed(list(enumerate(row))):
                put(svg, cell, i, column, factor, x,
                    TOP + 4 + (k + 0.5) * ROW + (i - middle) * 4)


def colour(i):
    """Of variant i."""
    return COLOURS[i % len(COLOURS)]


def marker(i):
    """Of variant i; once the colours repeat, each has another marker than before."""
    return MARKERS[(i + i // len(COLOURS)) % len(MARKERS)]


def legend(svg, variants):
    left = LEFT
    for i, variant in enumerate(variants):
        svg.marker(marker(i), left, 42, 5, colour(i))
        svg.write(left + 10, 46, variant)
        left += 40 + text_width(variant, 12)


def area(svg, scenes, x, height, label):
    svg.box(LEFT, TOP, RIGHT - LEFT, height, "#fbfbfb")
    for k, scene in enumerate(scenes):
        y = TOP + 4 + (k + 0.5) * ROW
        svg.write(LEFT - 9, y + 4, scene, "end")
        svg.line(LEFT, y + 15, RIGHT, y + 15, "#e8e8e8")
    for value, text in x.ticks(9):
        svg.line(x.at(value), TOP, x.at(value), TOP + height, "#e0e0e0")
        svg.write(x.at(value), TOP + height + 17, text, "middle", 12, "#444444")
    svg.line(LEFT, TOP + height, RIGHT, TOP + height, "#444444")
    svg.write((LEFT + RIGHT) / 2, TOP + height + 40, label, "middle", 12.5)


def put(svg, cell, i, column, factor, x, y):
    if cell.mean(column) is None:
        return
    svg.line(x.at(factor * cell.least(column)), y, x.at(factor * cell.most(column)), y, colour(i),
             1.6)
    svg.marker(marker(i), x.at(factor * cell.mean(column)), y, 4.2, colour(i))
