"""What each part of the method is worth on a scene: the bars of the variants.
SPDX-License-Identifier: BSD-2-Clause"""
from collections import namedtuple

from ..compare import Change, base_of, within_seeds
from ..rows import mark, own_options
from ..seeded import Seeded, seeded_run
from ..words import fixed, signed
from . import first_bars
from .context import sweep
from .held_out import rests_on

PRIOR = "factorised costs at least 10 % more rate"
# against: a variant whose steps take much less time, with the core minutes of training of the
# largest files of both in the words; by default the variant's base. first: what makes the bar as it
# was first defined, of the runs and the scene.
Bar = namedtuple("Bar", "variant what limit first against", defaults=(None, None))
BARS = (
    Bar("concat", "bank against concat", "bank better", first_bars.concat),
    Bar("inr_paper", "bank against inr, a network as large as the paper's (8 layers of 256)",
        "bank better", first_bars.inr),
    Bar("inr_paper",
        "the same inr against the bank, trained as long as preset fast does, which takes less time",
        "bank better", first_bars.inr_paper, "whole_long"),
    Bar("inr", "bank against inr, layers as wide as F_deform's (the paper has no such row)",
        "bank better", first_bars.inr),
    Bar("factorised_flat",
        "inr prior against factorised prior, components independent as in the paper's", PRIOR,
        first_bars.prior),
    Bar("factorised_flat_auto",
        "the same two priors, both with the choice of capacity, as by default", PRIOR,
        first_bars.prior),
    Bar("factorised", "inr prior against factorised prior that keeps the autoregression (the paper "
        "has no such row)", PRIOR, first_bars.prior),
    Bar("factorised_auto", "inr prior against factorised prior with autoregression, both with the "
        "choice of capacity, as by default", PRIOR, first_bars.prior),
    Bar("factorised_long", "inr prior against factorised prior with autoregression, both trained "
        "as long as preset fast does", PRIOR, first_bars.prior),
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


def add_bars(report, scene):
    for one in BARS:
        variant_bar(report, scene, one)
    for one in RECIPE_BARS:
        recipe_bar(report, scene, *one)


def variant_bar(report, scene, bar):
    runs, variant, base = report.runs, bar.variant, bar.against or base_of(bar.variant)
    what = f"{scene}: {bar.what}"
    if bar.against:
        what += " (" + " against ".join(minutes(runs.first(scene, one))
                                        for one in (bar.against, variant)) + " core minutes)"
    how = sweep(f"'{scene}-{variant}-*' '{scene}-{base}-*'")
    change = Change(runs, scene, variant, base)
    if not change.runs or not runs.is_complete(scene, variant) or not runs.is_complete(scene, base):
        report.bars.add(1, what, bar.limit, "", None, how)
        return
    within, seeded = within_seeds(runs, scene, change), Seeded(runs, scene, variant)
    by_seeds = within and not is_prior(variant)
    ok = report.family.is_worse(seeded) if by_seeds else is_met(variant, change)
    report.bars.add(1, what, bar.limit, measured_text(report, scene, variant, change, seeded), ok,
                    how, bar.first and bar.first(runs, scene),
                    alone_text(report, seeded.is_worse_alone(), ok) if by_seeds else "")


def signs(runs, scene, other):
    """(is it worse on one scene, on the other) of each variant of the bars that both scenes have,
    where both can be said."""
    pairs = [tuple(Change(runs, one, variant).worse for one in (scene, other))
             for variant in dict.fromkeys(bar.variant for bar in BARS)]
    return [pair for pair in pairs if None not in pair]


def is_prior(variant):
    """Another prior begins where the whole method's stage 1 ends: seeds do not come between."""
    return variant.startswith("factorised")


def measured_text(report, scene, variant, change, seeded):
    runs = report.runs
    text = (f"`{own_options(runs, runs.first(scene, variant))}`: {rate_text(change)}, "
            f"PSNR at equal bytes {signed(change.psnr, 2, ' dB')}; nearest {change.near_words()}"
            f"{mark(runs.of(scene, variant) + runs.of(scene, change.base))}"
            f"{'; within seeds' if within_seeds(runs, scene, change) else ''}")
    if seeded.changes:
        text += (f"; at {len(seeded.changes)} seeds {seeded.by_seed()}, mean "
                 f"{seeded.mean_text()} dB{seeded.mark()}")
    return text + rests_on(report, scene, len(seeded.changes or [0]))


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
        return (change.near_psnr if change.psnr is None else change.psnr) <= -1
    return "?" if change.worse is None else change.worse


def recipe_bar(report, scene, changed, what, limit, least):
    runs = report.runs
    run = seeded_run(runs, scene, "recipe_" + changed, 1)
    if not run.in_group("recipe"):
        return
    seeded, measured, ok, more = Seeded(runs, scene, "recipe_" + changed), "", None, ""
    if seeded.changes:
        measured = (f"`{own_options(runs, run)}`: PSNR at equal bytes, "
                    f"{len(seeded.changes)} seeds: {seeded.by_seed()}, "
                    f"mean {seeded.mean_text()} dB{seeded.mark()}"
                    + rests_on(report, scene, len(seeded.changes)))
        alone, ok = (-seeded.mean >= least if worse is True else worse
                     for worse in (seeded.is_worse_alone(), report.family.is_worse(seeded)))
        more = alone_text(report, alone, ok)
    report.bars.add(1, f"{scene}, the paper's recipe alone: {what}", limit, measured, ok,
                    sweep(f"recipe '{scene}-recipe-*'"), more=more)
