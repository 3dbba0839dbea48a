"""When a run of the stability lab counts as failed, and where. The only place of these limits.
SPDX-License-Identifier: BSD-2-Clause"""
from .compare import mean

WORST_GAP = 2           # dB
WORST_FLOOR = 18        # dB: a worst frame below this shows something else than the scene
WORST_DROP = 5          # dB: with a worst frame that far below the mean, one view or time is lost
MOST_OUT = 0.01         # share of the drawn anchors
MOST_ESCAPES = 1 / 256  # share of symbols, as R-ENC-006 advises
MOST_ENDS = 0.001       # share of symbols or contexts: what they stand for is lost
MOST_SPREAD = 1         # dB between seeds of the whole method
WEAK_GAP = 2            # dB below the table's first scene, which nothing makes hard

# Of each rule: its letter on the page, and what it means.
RULES = {
    "crash": ("C", "ted4enc crashed"),
    "error": ("E", "ted4enc gave up with an error"),
    "nan": ("N", "a value is not finite: the decoder refuses a time, or the log has a value that "
                 "is no number"),
    "diverges": ("D", "the distortion ends above its start"),
    "rollback": ("B", "the divergence monitor rolled training back"),
    "gap": ("W", f"the worst frame lies more than {WORST_GAP} dB below the whole method's"),
    "floor": ("F", f"the worst frame lies below {WORST_FLOOR} dB"),
    "drop": ("P", f"the worst frame lies more than {WORST_DROP} dB below the mean of all frames"),
    "out": ("O", f"more than {100 * MOST_OUT:g} % of the drawn anchors are thrown out of every "
                 "picture"),
    "escapes": ("X", f"more than one in {1 / MOST_ESCAPES:g} symbols needs an escape"),
    "ends": ("R", f"more than {100 * MOST_ENDS:g} % of symbols or contexts lie at the ends of "
                  "their ranges"),
    "spread": ("S", f"seeds differ by more than {MOST_SPREAD} dB in mean PSNR"),
    "weak": ("L", f"the whole method's mean PSNR lies more than {WEAK_GAP} dB below its own on the "
                  "first scene"),
}


class Cell:
    """The runs of a variant on a scene."""

    def __init__(self, lab, scene, variant):
        self.lab, self.scene, self.variant = lab, scene, variant
        self.wanted = lab.runs.of(scene, variant)
        self.there = [run for run in self.wanted if run.has()]

    def numbers(self, column):
        return [run.number(column) for run in self.wanted if run.number(column) is not None]

    def mean(self, column):
        """None when no row has a number in that column; so least and most."""
        return mean(self.numbers(column))

    def least(self, column):
        return min(self.numbers(column), default=None)

    def most(self, column):
        return max(self.numbers(column), default=None)

    def sum(self, *columns):
        return sum(run.count(column) for run in self.wanted for column in columns)

    def spread(self):
        """Between seeds, of mean PSNR; None with fewer than two."""
        if len(self.there) < 2 or self.mean("psnr") is None:
            return None
        return self.most("psnr") - self.least("psnr")

    def is_weak(self):
        here = self.mean("psnr")
        first = self.lab.cell(self.lab.scenes[0], "whole").mean("psnr")
        return here is not None and first is not None and first - here > WEAK_GAP

    def breaks(self, rule):
        """How many rows break a rule; of spread and weak, which are the whole method's, all or
        none."""
        if rule in ("spread", "weak"):
            broken = self.variant == "whole" and (
                self.is_weak() if rule == "weak" else (self.spread() or 0) > MOST_SPREAD)
            return len(self.there) if broken else 0
        of_whole = self.lab.cell(self.scene, "whole").mean("worst")
        return sum(breaks(run, rule, of_whole) for run in self.there)

    def broken(self):
        """(letter, meaning, rows) of each rule that is broken."""
        found = [(*RULES[rule], self.breaks(rule)) for rule in RULES]
        return [one for one in found if one[2]]

    def marks(self):
        """Letters of what fails, each with the number of seeds where these are not all: "W O2"."""
        return " ".join(letter + (str(n) if n < len(self.there) else "")
                        for letter, _, n in self.broken())


def breaks(run, rule, of_whole):
    """Does a row break a rule of one row? of_whole: the mean of the whole method's worst frames."""
    if rule in ("crash", "error"):
        return run.text("status") == rule
    if run.text("status") != "fine":
        return False
    psnr, worst = run.count("psnr"), run.number("worst")
    broken = {
        "nan": sum(run.count(name) for name in
                   ("refused_views", "refused_times", "log_bad", "skipped")) > 0,
        "diverges": run.count("diverged") > 0,
        "rollback": run.count("rollbacks") > 0,
        "out": run.count("out_share") > MOST_OUT,
        "escapes": run.count("escape_share") > MOST_ESCAPES,
        "ends": run.count("symbol_ends") > MOST_ENDS or run.count("context_ends") > MOST_ENDS,
        "floor": worst is not None and worst < WORST_FLOOR,
        "drop": worst is not None and psnr - worst > WORST_DROP,
        "gap": worst is not None and of_whole is not None and of_whole - worst > WORST_GAP,
    }
    return broken[rule]
