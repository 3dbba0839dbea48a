"""What each part of the method is worth: the bars of the variants.
SPDX-License-Identifier: BSD-2-Clause"""
from collections import namedtuple

from ..compare import Change, base_of, within_seeds
from ..rows import mark, own_options
from ..seeded import Seeded, seeded_run
from ..words import fixed, signed
from . import first_bars
from .context import sweep
from .over_scenes import Judged, add_bar

FIRST = "kitchen"               # the scene on which the bars were first defined
STILL = ("still", "chair")      # where nothing moves, parts that model time are worth nothing
PRIOR = "factorised costs at least 10 % more rate"
# against: what the variant is compared with, which has to take less core time of training (of the
# largest files); by default the variant's base. first: what makes the bar as it was first defined,
# of the runs and the scene.
Bar = namedtuple("Bar", "variant what limit first against", defaults=(None, None))
BARS = (
    Bar("concat", "bank against concat", "bank better", first_bars.concat),
    Bar("inr_paper", "bank against inr, a network as large as the paper's (8 layers of 256)",
        "bank better", first_bars.inr),
    Bar("inr_paper",
        "the same inr against the bank with preset fast, in less core time", "bank better",
        first_bars.inr_paper, "fast"),
    Bar("inr", "bank against inr, layers as wide as F_deform's (the paper has no such row)",
        "bank better", first_bars.inr),
    Bar("factorised_flat",
        "hyperprior against factorised prior, components independent as in the paper's", PRIOR,
        first_bars.prior),
    Bar("factorised_flat_auto",
        "the same two priors, both with the choice of capacity, as by default", PRIOR,
        first_bars.prior),
    Bar("factorised", "hyperprior against factorised prior that keeps the autoregression (the "
        "paper has no such row)", PRIOR, first_bars.prior),
    Bar("factorised_auto", "hyperprior against factorised prior with autoregression, both with the "
        "choice of capacity, as by default", PRIOR, first_bars.prior),
    Bar("noactive", "no activation", "costs rate or quality"),
    Bar("noprogress", "no progressive training", "costs quality", first_bars.noprogress),
    Bar("static", "no deformation, nor activation, as in the paper's row",
        "far worse (here: at least 1 dB)", first_bars.nomotion),
    Bar("nomotion", "no deformation, all else kept (the paper has no such row)", "worse",
        first_bars.nomotion),
)
# The last number: how many dB worse the mean has to be.
RECIPE_BARS = (
    ("inr", "bank against inr, layers as wide as F_deform's", "bank better", 0),
    ("concat", "bank against concat", "bank better", 0),
    ("noactive", "no activation", "costs rate or quality", 0),
    ("noprogress", "no progressive training", "costs quality", 0),
    ("nomotion", "no deformation, activation kept", "far worse (here: at least 1 dB)", 1),
)


def add_bars(report):
    for one in BARS:
        variant_bar(report, one)
    for one in RECIPE_BARS:
        recipe_bar(report, *one)


def scenes_of(runs, variant):
    """Scenes of the table on which a variant, or a change of the paper's recipe, says something
    about a part of the method."""
    return [scene for scene in runs.scenes if runs.of(scene, variant) and scene not in STILL]


def has_rows(runs, scene, variant, base):
    """Whether the variant and its base can be compared there: all of their runs are there, except
    those that only a comparison over seeds asks for."""
    own = [run for run in runs.of(scene, variant) if not run.in_group("seeded")]
    return (bool(runs.present(scene, variant) and runs.present(scene, base))
            and all(run.has() for run in own) and runs.is_complete(scene, base))


def variant_bar(report, bar):
    runs, base = report.runs, bar.against or base_of(bar.variant)
    scenes = scenes_of(runs, bar.variant) or [FIRST]
    there = [scene for scene in scenes if has_rows(runs, scene, bar.variant, base)]
    patterns = " ".join(f"'{scene}-{one}-*'" for scene in scenes for one in (bar.variant, base))
    add_bar(report, bar.what, bar.limit, [judged_on(report, scene, bar, base) for scene in there],
            [scene for scene in scenes if scene not in there], sweep(patterns),
            bar.first and bar.first(runs, FIRST))


def judged_on(report, scene, bar, base):
    runs, variant = report.runs, bar.variant
    change = Change(runs, scene, variant, base)
    seeded = Seeded(runs, scene, variant)
    by_seeds = within_seeds(runs, scene, change) and not is_prior(variant)
    ok = report.family.is_worse(seeded) if by_seeds else is_met(variant, change)
    measured = measured_text(runs, scene, variant, change, seeded)
    more = alone_text(report, seeded.is_worse_alone(), ok) if by_seeds else ""
    if bar.against:
        base_run, run = runs.first(scene, bar.against), runs.first(scene, variant)
        measured += f"; {minutes(base_run)} against {minutes(run)} core minutes"
        if ok is True and not 0 < base_run.count("cpu_s") < run.count("cpu_s"):
            ok, more = "?", "not in less time"
    return Judged(scene, own_options(runs, runs.first(scene, variant)), measured, ok, more,
                  len(seeded.changes or [0]))


def is_prior(variant):
    """Another prior begins where the whole method's stage 1 ends: seeds do not come between."""
    return variant.startswith("factorised")


def measured_text(runs, scene, variant, change, seeded):
    text = (f"{rate_text(change)}, PSNR at equal bytes {signed(change.psnr, 2, ' dB')}; nearest "
            f"{change.near_words()}"
            f"{mark(runs.of(scene, variant) + runs.of(scene, change.base))}"
            f"{'; within seeds' if within_seeds(runs, scene, change) else ''}")
    if seeded.changes:
        text += (f"; at {len(seeded.changes)} seeds {seeded.by_seed()}, mean "
                 f"{seeded.mean_text()} dB{seeded.mark()}")
    return text


def alone_text(report, alone, ok):
    """Of a verdict that no longer holds when all comparisons are judged together."""
    if alone == ok or alone == "?":
        return ""
    return (f"{report.bars.WORDS[alone]} when judged alone, not among the "
            f"{report.family.count} comparisons over seeds")


def rate_text(change):
    """BD-rate; where there is none, the rate at equal PSNR, which a single run has."""
    if change.bd_rate is not None or change.rate is None:
        return f"BD-rate {change.bd_rate_text()}"
    return f"BD-rate -, rate at equal PSNR {signed(change.rate, 1, ' %')}"


def minutes(run):
    seconds = run.number("cpu_s")
    return fixed(None if seconds is None else seconds / 60, 0)


def is_met(variant, change):
    if is_prior(variant):
        return "?" if change.bd_rate is None else change.bd_rate >= 10
    if variant == "static":
        loss = change.near_psnr if change.psnr is None else change.psnr
        return "?" if loss is None else loss <= -1
    return "?" if change.worse is None else change.worse


def recipe_bar(report, changed, what, limit, least):
    runs, variant = report.runs, "recipe_" + changed
    scenes = [scene for scene in scenes_of(runs, variant)
              if seeded_run(runs, scene, variant, 1).in_group("recipe")]
    compared = [Seeded(runs, scene, variant) for scene in scenes]
    if scenes:
        add_bar(report, f"the paper's recipe alone: {what}", limit,
                [recipe_judged(report, seeded, least) for seeded in compared if seeded.changes],
                [seeded.scene for seeded in compared if not seeded.changes],
                sweep("recipe " + " ".join(f"'{scene}-recipe-*'" for scene in scenes)))


def recipe_judged(report, seeded, least):
    alone, ok = (-seeded.mean >= least if worse is True else worse
                 for worse in (seeded.is_worse_alone(), report.family.is_worse(seeded)))
    return Judged(seeded.scene, own_options(report.runs, seeded.pairs[0][0]),
                  f"PSNR at equal bytes, {len(seeded.changes)} seeds: {seeded.by_seed()}, "
                  f"mean {seeded.mean_text()} dB{seeded.mark()}",
                  ok, alone_text(report, alone, ok), len(seeded.changes))
