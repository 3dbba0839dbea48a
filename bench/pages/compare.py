"""A variant against the whole method on the same scene.
SPDX-License-Identifier: BSD-2-Clause"""
import math

from . import curves
from .rows import mark
from .words import signed


def base_of(variant):
    """What a variant is compared with: the whole method; with the choice of capacity
    (VARIANT_auto), that with the same."""
    return "whole_auto" if variant.endswith("_auto") else "whole"


def curve_of(rows):
    """Points (PSNR in dB, natural logarithm of bytes) in order of PSNR."""
    points = [(run.count("psnr"), math.log(run.count("bytes"))) for run in rows]
    return sorted(points, key=lambda point: point[0])


def base_rows(runs, run, against=None):
    """The rows that a row may be compared with: those of its base, of the present sources if the
    row is, otherwise of earlier ones."""
    base = runs.present(run.scene, against or base_of(run.variant))
    return [other for other in base if other.is_old() == run.is_old()]


def is_mixed(rows):
    """Did the present sources make some of these rows, and others the rest?"""
    return len({run.is_old() for run in rows}) > 1


def of_one_encoder(ok, text, rows):
    """A verdict and what it is about, with the mark of the rows behind them: undecided where
    the present sources made only some of these."""
    there = [run for run in rows if run.has()]
    if ok is not None and is_mixed(there):
        return "?", f"{text}{mark(there)}; the rows are of two encoders"
    return ok, text and text + mark(there)


def rate_change(runs, run, against=None):
    """Bytes at the same PSNR against the curve of its base, percent; None where that does not
    reach."""
    curve = curve_of(base_rows(runs, run, against))
    at = curves.value_at(curve, run.count("psnr"))
    return None if at is None else curves.as_percent(math.log(run.count("bytes")) - at)


def psnr_change(runs, run, against=None):
    """PSNR at the same bytes, dB, likewise."""
    curve = curves.swapped(curve_of(base_rows(runs, run, against)))
    at = curves.value_at(curve, math.log(run.count("bytes")))
    return None if at is None else run.count("psnr") - at


def nearest(runs, run, against=None):
    """The run of its base that is nearest in quality; None when there is none."""
    return min(base_rows(runs, run, against), default=None,
               key=lambda other: abs(other.count("psnr") - run.count("psnr")))


def mean(values):
    """Of those that are not None; None without any."""
    known = [value for value in values if value is not None]
    return sum(known) / len(known) if known else None


class Change:
    """Of a variant on a scene, from those of its runs that are there:

    base                  what it is compared with
    runs                  how many
    rate, psnr            means of rate_change and psnr_change over the runs that the curve reaches
    near_psnr, near_rate  mean differences to the nearest points, dB and percent
    bd_rate               BD-rate: mean rate between the two curves at the same lambdas, percent:
                          on Bjontegaard's cubics; with fewer than four points on straight lines;
                          None with fewer than two, where the curves share no PSNR, or where the
                          present sources made only some of the rows
    is_cubic              which of the two
    worse                 than the base: True, False, or None: undecided"""

    def __init__(self, runs, scene, variant, against=None):
        self.base = base = against or base_of(variant)
        near = [(run, nearest(runs, run, base)) for run in runs.present(scene, variant)]
        near = [(run, other) for run, other in near if other is not None]
        self.runs = len(near)
        self.rate = mean([rate_change(runs, run, base) for run, _ in near])
        self.psnr = mean([psnr_change(runs, run, base) for run, _ in near])
        self.near_psnr = mean([run.count("psnr") - other.count("psnr") for run, other in near])
        self.near_rate = curves.as_percent(mean([
            math.log(run.count("bytes") / other.count("bytes")) for run, other in near]))
        rows = runs.present(scene, variant)
        weights = {run.weight for run in rows}
        base_of_rows = [run for run in runs.present(scene, base) if run.weight in weights]
        a, b = curve_of(base_of_rows), curve_of(rows)
        cubic = curves.bjontegaard(a, b)
        self.is_cubic = cubic is not None
        self.bd_rate = curves.as_percent(cubic if self.is_cubic else curves.mean_gap(a, b))
        if is_mixed(rows + base_of_rows):
            self.bd_rate = None
        self.worse = self.is_worse() if self.runs else None

    def is_worse(self):
        """At equal bytes, else at equal PSNR, else when one of them is better on both counts than
        the other's nearest points."""
        if self.psnr is not None:
            return self.psnr < 0
        if self.rate is not None:
            return self.rate > 0
        if self.near_psnr <= 0 <= self.near_rate:
            return True
        return False if self.near_psnr >= 0 >= self.near_rate else None

    def bd_rate_text(self):
        """BD-rate, and how it was found."""
        if self.bd_rate is None:
            return "-"
        return signed(self.bd_rate, 1, " %") + (" (cubic)" if self.is_cubic else " (lines)")

    def near_words(self):
        return near_words(self.near_psnr, self.near_rate)


def near_words(psnr, rate):
    return signed(psnr, 2, " dB") + ", " + signed(rate, 1, " %")


def whole_run(runs, scene, seed):
    """The whole method's run with that seed."""
    return runs.find(f"{scene}-{'whole' if seed == 1 else f'seed{seed}'}-2")


def seed_spread(runs, scene):
    """Greatest less least of seeds 1 to 3, by column, so that scenes with more of them compare;
    share: of the bytes, percent of the least. None when one is missing, or the present sources made
    only some of them."""
    three = [whole_run(runs, scene, seed) for seed in (1, 2, 3)]
    if not all(run.has() for run in three) or is_mixed(three):
        return None
    spread = {}
    for column in ("psnr", "ssim", "bytes", "anchors"):
        values = [run.count(column) for run in three]
        spread[column] = max(values) - min(values)
    least = min(run.count("bytes") for run in three)
    spread["share"] = 100 * spread["bytes"] / least
    return spread


def within_seeds(runs, scene, change):
    """Is the difference to the whole method no more than what seeds alone make? Not where the
    seeds were not run, or the curve does not reach."""
    spread = seed_spread(runs, scene)
    return change.psnr is not None and spread is not None and abs(change.psnr) < spread["psnr"]
