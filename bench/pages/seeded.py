"""A variant against the whole method over several seeds: differences that one seed cannot tell.
SPDX-License-Identifier: BSD-2-Clause"""
import math

from .compare import is_mixed, psnr_change, whole_run
from .rows import mark
from .significance import LEVEL, holm, student_tail
from .words import fixed, signed


class Seeded:
    """A variant against its base, seed by seed, at equal bytes: runs SCENE-VARIANT-2,
    SCENE-VARIANT_seed2-2, ... of the group "seeded" against the whole method's; those of the group
    "recipe" against SCENE-recipe-2, SCENE-recipe_seed2-2, ...

    changes: by seed, dB; None when one is missing, or there is one seed alone. With them: mean, dB;
    error: its standard error, dB; chance: the probability that chance alone makes a mean that lies
    at least as far from zero, on either side."""

    def __init__(self, runs, scene, variant):
        self.scene, self.variant = scene, variant
        self.is_recipe = variant.startswith("recipe_")
        group = "recipe" if self.is_recipe else "seeded"
        self.pairs = []
        for seed in range(1, 11):
            run = seeded_run(runs, scene, variant, seed)
            if not run.in_group(group):
                break
            self.pairs.append((run, seeded_run(runs, scene, "recipe", seed) if self.is_recipe
                               else whole_run(runs, scene, seed)))
        self.base = "recipe" if self.is_recipe else "whole"
        self.curve = runs.of(scene, self.base)
        self.changes = [self.change(runs, *pair) for pair in self.pairs]
        if len(self.changes) < 2 or None in self.changes:
            self.changes = None
            return
        n = len(self.changes)
        total, square = sum(self.changes), sum(c * c for c in self.changes)
        self.mean = total / n
        self.error = (math.sqrt((square - total * total / n) / (n - 1) / n)
                      if square * n > total * total else 0)
        self.chance = (2 * student_tail(abs(self.mean) / self.error, n - 1) if self.error
                       else 0 if self.mean else 1)

    def change(self, runs, run, other):
        """PSNR of a run less that of another, had both as many bytes: along the curve of the base
        at seed 1. None where one is missing, the curve does not reach, or the present sources made
        one of them only."""
        if not run.has() or not other.has() or is_mixed([run, other]):
            return None
        of_run, of_other = (psnr_change(runs, one, self.base) for one in (run, other))
        return None if of_run is None or of_other is None else of_run - of_other

    def is_worse_alone(self):
        """Whether the mean, judged by itself, lies farther from zero than chance puts it once in
        twenty, on either side: True worse, False better, "?" inconclusive, as without changes."""
        if self.changes is None or self.chance > LEVEL:
            return "?"
        return self.mean < 0

    def by_seed(self):
        return ", ".join(signed(change, 2) for change in self.changes)

    def mean_text(self):
        return signed(self.mean, 2) + " ± " + fixed(self.error, 2)

    def mark(self):
        """Of all rows that the changes come from."""
        return mark(self.curve + [run for pair in self.pairs for run in pair])


def seeded_run(runs, scene, variant, seed):
    return runs.find(f"{scene}-{variant}{'' if seed == 1 else f'_seed{seed}'}-2")


def seeded_variants(runs, group):
    """(scene, variant) of the runs with a seed 1 of a group."""
    return [(scene, variant) for scene in runs.scenes for variant in runs.variants
            if "_seed" not in variant and seeded_run(runs, scene, variant, 1).in_group(group)]


class Family:
    """All comparisons over seeds of the report, judged together, each for both sides: all of them
    hold with a chance of at most LEVEL that one of them is wrong (Holm's correction).

    count: how many have all their runs."""

    def __init__(self, runs):
        wanted = [pair for group in ("seeded", "recipe") for pair in seeded_variants(runs, group)]
        self.all = [Seeded(runs, *pair) for pair in wanted if pair[1] != "recipe"]
        judged = [seeded for seeded in self.all if seeded.changes]
        self.count = len(judged)
        self.holding = holm({(seeded.scene, seeded.variant): seeded.chance for seeded in judged})

    def is_worse(self, seeded):
        """True worse, False better, "?" inconclusive."""
        if (seeded.scene, seeded.variant) not in self.holding:
            return "?"
        return seeded.mean < 0

    def holds(self):
        """How many verdicts hold by themselves, and how many among all, as a sentence."""
        alone = sum(seeded.is_worse_alone() != "?" for seeded in self.all)
        show = "shows" if alone == 1 else "show"
        return (f"Of {self.count} comparisons {alone} {show} a significant difference if each is "
                f"judged alone, and {len(self.holding)} if all are judged together.")
