"""The wanted runs with the rows that are there.

Of the rows of a CSV those count that the wanted options made, with these sources or older ones. A
row that other options made is none. Each run has a state, which the script that makes the rows
tells: done, equal (made by other sources, which bench/equal.csv knows to write the same bytes),
older, stale or missing.
SPDX-License-Identifier: BSD-2-Clause"""
import sys

from .wanted import Run


class Measured(Run):
    """A wanted run that may have a row."""

    def has(self):
        return self.row is not None

    def is_old(self):
        """Sources that may write other bytes than the present ones made the row."""
        return self.has() and self.state not in ("done", "equal")

    def name(self):
        return self.tag + ("†" if self.is_old() else "")

    def text(self, column):
        """A cell as it stands; "" when it, the row or the column is not there."""
        return self.row.get(column, "") if self.row else ""

    def number(self, column):
        """A cell as a number; None when it is not there, or empty."""
        text = self.text(column)
        return None if text == "" else float(text)

    def count(self, column):
        """The same with 0 for what is not there."""
        return self.number(column) or 0

    def in_group(self, group):
        return group in self.groups.split("+")

    def keeps(self, what):
        return what in self.keep.split("+")

    def payload(self):
        """Bytes of the attributes' substreams."""
        return sum(self.count("b_" + name) for name in "feature scaling offset phi tau".split())

    def estimate_error(self):
        """Percent by which the bits that training estimates differ from those of the attributes'
        substreams in the file, each of which ends with a whole byte; None when not known."""
        bits = self.number("estimated_bits")
        return None if bits is None or not self.payload() else 100 * (bits / 8 / self.payload() - 1)

    def position_bits(self):
        """Bits of the file for the position of an anchor; None when they are not known."""
        anchors = self.count("anchors")
        return 8 * self.count("b_positions") / anchors if anchors else None

    def picture_ms(self):
        """Milliseconds to decode the file on one thread and to draw one picture with the threads
        of the run; None when one of them is not known."""
        decode, speed = self.number("decode_ms"), self.number("render_fps")
        return None if decode is None or not speed or speed <= 0 else decode + 1000 / speed


def mark(runs):
    """A dagger when other sources made one of these rows."""
    return "†" if any(run.is_old() for run in runs) else ""


def made_with(runs):
    """Which of these rows the present sources did not make, to be added to a sentence."""
    equal = sum(run.has() and run.state == "equal" for run in runs)
    old = sum(run.is_old() for run in runs)
    return ((f", {equal} of them made by earlier sources that write the same bytes"
             " ([equal.csv](equal.csv))" if equal else "")
            + (f", {old} of them older than the present sources (†)" if old else ""))


class Runs:
    """wanted: the table's, as Measured. all: in its order. scenes, variants: in the order in which
    they first come. where: the folder of each scene."""

    def __init__(self, wanted, states, csv):
        self.all, self.tags, self.scenes, self.variants = [], {}, [], []
        self.strangers = self.others = 0
        self.by_variant, self.where = {}, {}
        for run in wanted:
            run.state = states.get(run.tag, "missing")
            self.add(run)
        for runs in self.by_variant.values():
            runs.sort(key=lambda run: float(run.weight or 0))
        self.read(csv)

    def add(self, run):
        self.all.append(run)
        self.tags[run.tag] = run
        self.where[run.scene] = run.where
        if run.scene not in self.scenes:
            self.scenes.append(run.scene)
        if run.variant not in self.variants:
            self.variants.append(run.variant)
        self.by_variant.setdefault((run.scene, run.variant), []).append(run)

    def read(self, csv):
        try:
            with open(csv, encoding="utf-8") as file:
                lines = file.read().splitlines()
        except FileNotFoundError:
            return
        if not lines:
            sys.exit(f"{csv}: no line with the names of columns")
        columns = lines[0].split(",")
        for number, line in enumerate(lines[1:], 2):
            cells = line.split(",")
            if len(cells) != len(columns):
                sys.exit(f"{csv}:{number}: {len(columns)} columns expected")
            run = self.tags.get(cells[0])
            if run is None:
                self.strangers += 1
            elif run.state == "stale":
                self.others += 1
            else:
                run.row = dict(zip(columns, cells))

    def of(self, scene, variant):
        """The runs of a variant on a scene, by rising lambda."""
        return self.by_variant.get((scene, variant), [])

    def first(self, scene, variant):
        """The first of them, or a run that nobody wants and that has no row."""
        runs = self.of(scene, variant)
        return runs[0] if runs else Measured("")

    def find(self, tag):
        return self.tags.get(tag) or Measured(tag)

    def present(self, scene, variant):
        return [run for run in self.of(scene, variant) if run.has()]

    def is_complete(self, scene, variant):
        return len(self.present(scene, variant)) == len(self.of(scene, variant))

    def wants(self, scene, variant, group):
        """A variant of a scene belongs to a group when its first run does."""
        return self.first(scene, variant).in_group(group)

    def curve_scenes(self):
        """Scenes that rate and distortion are shown on: the whole method at more than one lambda,
        in the group "rd"."""
        return [scene for scene in self.scenes if len(self.of(scene, "whole")) > 1
                and self.wants(scene, "whole", "rd")]

    def summary(self):
        """How many of the wanted rows are there, as a sentence without its full stop."""
        return (f"{sum(run.has() for run in self.all)} of {len(self.all)} wanted runs are there"
                + made_with(self.all))


def own_options(runs, run, names=("set", "preset", "seed", "downscale", "capacity", "black",
                                  "alpha", "hold-out")):
    """Options that a run has and the first run of the whole method on its scene has not, among
    those of these names."""
    base = f" {runs.first(run.scene, 'whole').options} "
    parts = []
    for word in run.options.split():
        if word.startswith("--"):
            parts.append(word)
        else:
            parts[-1] += " " + word
    return " ".join(part for part in parts
                    if part.split()[0][2:] in names and f" {part} " not in base)
