"""A panel of points over two axes, in series joined by lines, with a legend above the data.
SPDX-License-Identifier: BSD-2-Clause"""
from . import axes
from .svg import COLOURS, MARKERS, text_width

LEGEND = 62     # pixels left of an area, for the numbers and the label of its y axis


class Series:
    """dash: "" solid, "-" no line, else lengths. above: notes stand above their points."""

    def __init__(self, name, colour, marker, dash, above):
        self.name, self.colour, self.marker = name, colour, marker
        self.dash, self.above, self.points = dash, above, []

    def point(self, x, y, note=""):
        """Ignored where one of the two is not known."""
        if x is not None and y is not None:
            self.points.append((float(x), float(y), note))


class Plot:
    def __init__(self):
        self.all = []

    def series(self, name, colour, marker, dash="", above=False):
        self.all.append(Series(name, colour, marker, dash, above))
        return self.all[-1]

    def curve(self, runs, scene, variant, name, colour, marker, dash="", notes=False):
        """PSNR over kB of a variant's runs on a scene. notes: with lambda at the points."""
        series = self.series(name, colour, marker, dash)
        for run in runs.present(scene, variant):
            series.point(run.count("bytes") / 1000, run.number("psnr"),
                         run.weight if notes else "")

    def is_empty(self):
        return not any(series.points for series in self.all)

    def draw(self, svg, left, top, width, height, title, x_label, y_label, log_x=False, ticks=None):
        """Into the box. ticks: values of x that have one, as text. A panel without points gets a
        word instead."""
        svg.write(left + LEGEND, top + 18, title, "start", 14, "#111111", bold=True)
        used = 28 + self.legend(svg, left + LEGEND, top + 28, width - LEGEND)
        left, top, width, height = left + LEGEND, top + used, width - 78, height - used - 46
        if self.is_empty():
            svg.box(left, top, width, height, "#fbfbfb", "#dddddd")
            svg.write(left + width / 2, top + height / 2, "not run yet", "middle", 13, "#777777")
            return
        points = [point for series in self.all for point in series.points]
        x = axes.Axis(min(p[0] for p in points), max(p[0] for p in points), left, left + width,
                      log=log_x)
        y = axes.Axis(min(p[1] for p in points), max(p[1] for p in points), top + height, top,
                      axes.ROOM_Y)
        axes.area(svg, left, top, width, height, x, y,
                  [(float(tick), tick) for tick in ticks.split()] if ticks else None)
        axes.labels(svg, left, top, width, height, x_label, y_label)
        for series in reversed(self.all):
            if series.dash != "-" and len(series.points) > 1:
                svg.polyline([(x.at(p[0]), y.at(p[1])) for p in series.points], series.colour, 2,
                             series.dash)
        for series in reversed(self.all):
            for point in series.points:
                put_mark(svg, series, x.at(point[0]), y.at(point[1]), point[2], x.end)

    def legend(self, svg, left, top, width):
        """Names of the series in rows that fit; the height of them. Series without points or a
        name are left out."""
        x, y = left, top + 6
        for series in self.all:
            if not series.points or not series.name:
                continue
            wide = text_width(series.name, 12) + 42
            if x > left and x + wide > left + width:
                x, y = left, y + 18
            if series.dash != "-":
                svg.line(x, y, x + 24, y, series.colour, 2, series.dash)
            svg.marker(series.marker, x + 12, y, 4.6, series.colour)
            svg.write(x + 29, y + 4, series.name)
            x += wide
        return y - top + 16


def put_mark(svg, series, x, y, note, right):
    """Notes stand below and right of a point: rate-distortion curves bend the other way. Near the
    right edge they stand below it, to the left."""
    svg.marker(series.marker, x, y, 4.6, series.colour)
    if note:
        far = x + 10 + text_width(note, 11) > right
        svg.note(x + 12 if far else x + 7, y - 8 if series.above else y + 19 if far else y + 15,
                 note, "end" if far else "start", "#333333")


class SceneStyles:
    """The look of each scene in all charts of a page; scenes without a curve share one. Black is no
    scene's, so that there is one colour less than markers, and both together repeat late."""

    def __init__(self, scenes):
        self.scenes = scenes

    def colour(self, scene):
        own = COLOURS[1:]
        return own[self.scenes.index(scene) % len(own)] if scene in self.scenes else "#666666"

    def marker(self, scene):
        return (MARKERS[self.scenes.index(scene) % len(MARKERS)] if scene in self.scenes
                else "cross")


def panels(count, height):
    """The height of a picture of panels, two beside each other; and the place of each."""
    return (count + 1) // 2 * height, [(k % 2 * 450, k // 2 * height + 4) for k in range(count)]
