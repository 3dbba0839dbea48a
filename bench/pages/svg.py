"""Marks of charts as SVG text: lines, words, boxes, markers. Coordinates in pixels, y down.

Every coordinate is printed with at most two decimals, so that the same rows give the same bytes.
SPDX-License-Identifier: BSD-2-Clause"""

# Colours of Okabe and Ito, which colour-blind readers can tell apart; markers differ, too.
COLOURS = "#000000 #0072b2 #d55e00 #009e73 #cc79a7 #e69f00 #56b4e9 #666666".split()
MARKERS = "circle square triangle diamond down circle square triangle".split()
CORNERS = {
    "square": (0.9, "-1 -1 1 -1 1 1 -1 1"),
    "triangle": (1.15, "0 -1 1 0.8 -1 0.8"),
    "down": (1.15, "0 1 1 -0.8 -1 -0.8"),
    "diamond": (1.3, "0 -1 1 0 0 1 -1 0"),
}


def px(value):
    return f"{value:.2f}".rstrip("0").rstrip(".")


def escape(text):
    return text.replace("&", "&amp;").replace("<", "&lt;").replace(">", "&gt;")


def text_width(text, size):
    """In pixels, roughly."""
    return len(text) * size * 0.57


class Charts:
    """The charts of a page. folder: where they are written. place: how the page names it."""

    def __init__(self, folder, place):
        self.folder, self.place, self.drawn = folder, place, set()

    def open(self, name, width, height, title):
        self.drawn.add(name)
        return Svg(f"{self.folder}/{name}.svg", width, height, title)


class Svg:
    """A picture, written when the `with` block that it opens ends."""

    def __init__(self, path, width, height, title):
        self.path = path
        self.parts = [
            f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}"'
            f' viewBox="0 0 {width} {height}"'
            ' font-family="DejaVu Sans, Verdana, Helvetica, Arial, sans-serif" font-size="12"'
            ' role="img">',
            f"<title>{escape(title)}</title>",
            f'<rect width="{width}" height="{height}" fill="#ffffff"/>']

    def __enter__(self):
        return self

    def __exit__(self, kind, *_):
        if kind is None:
            with open(self.path, "w", encoding="utf-8") as file:
                file.write("\n".join(self.parts + ["</svg>"]) + "\n")

    def put(self, text):
        self.parts.append(text)

    def line(self, x1, y1, x2, y2, colour, width=1, dash=""):
        self.put(f'<line x1="{px(x1)}" y1="{px(y1)}" x2="{px(x2)}" y2="{px(y2)}"'
                 f' stroke="{colour}"' + ("" if width == 1 else f' stroke-width="{width:g}"')
                 + f"{dashes(dash)}/>")

    def write(self, x, y, text, place="start", size=12, colour="#222222", bold=False, up=False):
        """place: start, middle or end. up: words that run upwards."""
        self.put(f'<text x="{px(x)}" y="{px(y)}"{anchored(place)}'
                 + ("" if size == 12 else f' font-size="{size:g}"')
                 + f' fill="{colour}"' + (' font-weight="bold"' if bold else "")
                 + (f' transform="rotate(-90 {px(x)} {px(y)})"' if up else "")
                 + f">{escape(text)}</text>")

    def note(self, x, y, text, place, colour):
        """Words on a white halo, for those that stand among data."""
        self.put(f'<text x="{px(x)}" y="{px(y)}"{anchored(place)} font-size="11"'
                 f' fill="{colour}" stroke="#ffffff" stroke-width="3" stroke-linejoin="round"'
                 f' paint-order="stroke">{escape(text)}</text>')

    def box(self, x, y, width, height, fill, stroke=""):
        self.put(f'<rect x="{px(x)}" y="{px(y)}" width="{px(width)}" height="{px(height)}"'
                 f' fill="{fill}"' + (f' stroke="{stroke}"' if stroke else "") + "/>")

    def polyline(self, points, colour, width, dash=""):
        places = " ".join(f"{px(x)},{px(y)}" for x, y in points)
        self.put(f'<polyline points="{places}" fill="none" stroke="{colour}"'
                 f' stroke-width="{width:g}" stroke-linejoin="round" stroke-linecap="round"'
                 f"{dashes(dash)}/>")

    def marker(self, kind, x, y, radius, colour):
        """Of about that radius around its centre; a white edge keeps neighbours apart."""
        edge = ' stroke="#ffffff"/>'
        if kind == "circle":
            self.put(f'<circle cx="{px(x)}" cy="{px(y)}" r="{px(radius)}" fill="{colour}"{edge}')
        elif kind == "ring":
            self.put(f'<circle cx="{px(x)}" cy="{px(y)}" r="{px(radius)}" fill="#ffffff"'
                     f' stroke="{colour}" stroke-width="2"/>')
        elif kind == "cross":
            self.line(x - radius, y - radius, x + radius, y + radius, colour, 2.4)
            self.line(x - radius, y + radius, x + radius, y - radius, colour, 2.4)
        elif kind in CORNERS:
            scale, corners = CORNERS[kind]
            corners = [float(c) for c in corners.split()]
            places = " ".join(f"{px(x + scale * radius * a)},{px(y + scale * radius * b)}"
                              for a, b in zip(corners[::2], corners[1::2]))
            self.put(f'<polygon points="{places}" fill="{colour}"{edge}')


def anchored(place):
    return "" if place == "start" else f' text-anchor="{place}"'


def dashes(lengths):
    return f' stroke-dasharray="{lengths}"' if lengths else ""
