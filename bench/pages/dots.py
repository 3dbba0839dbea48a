"""Panels of dots over one number: a named row each, a marker for each scene.
SPDX-License-Identifier: BSD-2-Clause"""
from . import axes
from .svg import text_width

ROW = 24    # pixels


class Dots:
    """styles: of scenes (plot.SceneStyles). band: what is that near to 0 is set off; 0 none."""

    def __init__(self, styles, band=0):
        self.styles, self.band = styles, band
        self.rows, self.values, self.words = [], {1: [], 2: []}, {}

    def row(self, name):
        self.rows.append(name)

    def value(self, panel, value, scene):
        """Into the last row."""
        if value is not None:
            self.values[panel].append((value, len(self.rows), scene))

    def word(self, panel, text):
        """Into the last row of a panel in which there is nothing to mark."""
        self.words[panel, len(self.rows)] = text

    def height(self):
        return len(self.rows) * ROW + 8

    def legend(self, svg, left, y):
        """Of scenes that occur anywhere, in a line; those without a curve share one look."""
        found = {value[2] for panel in self.values.values() for value in panel}
        names = [(scene, scene) for scene in self.styles.scenes if scene in found]
        if found - set(self.styles.scenes):
            names.append(("", "other scenes"))
        for scene, text in names:
            svg.marker(self.styles.marker(scene), left, y, 5, self.styles.colour(scene))
            svg.write(left + 11, y + 4, text)
            left += 44 + text_width(text, 12)

    def draw(self, svg, left, top, width, panel, label, names=False):
        """names: those of the rows are written left of the panel. 0 is always shown, by a darker
        line."""
        height = self.height()
        svg.box(left, top, width, height, "#fbfbfb")
        values = [value[0] for value in self.values[panel]] + [-self.band, self.band]
        x = axes.Axis(min(values), max(values), left, left + width)
        if self.band:
            svg.box(x.at(-self.band), top, x.at(self.band) - x.at(-self.band), height, "#dff1e8")
        for i, name in enumerate(self.rows, 1):
            y = top + 4 + (i - 0.5) * ROW
            svg.line(left, y, left + width, y, "#e8e8e8")
            if names:
                svg.write(left - 9, y + 4, name, "end")
            if (panel, i) in self.words:
                svg.write(left + width / 2, y + 4, self.words[panel, i], "middle", 11, "#777777")
        for value, text in x.ticks(6):
            at = x.at(value)
            svg.line(at, top, at, top + height, "#444444" if value == 0 else "#e0e0e0")
            svg.write(at, top + height + 17, text, "middle", 12, "#444444")
        svg.line(left, top + height, left + width, top + height, "#444444")
        svg.write(left + width / 2, top + height + 38, label, "middle", 12.5)
        for value, row, scene in self.values[panel]:
            y = top + 4 + (row - 0.5) * ROW + self.shift(scene)
            svg.marker(self.styles.marker(scene), x.at(value), y, 5, self.styles.colour(scene))

    def shift(self, scene):
        """Scenes lie beside each other in a row, so that none hides another."""
        scenes = self.styles.scenes
        return (scenes.index(scene) - (len(scenes) - 1) / 2) * 2.6 if scene in scenes else 0
