"""What each part of the method is worth on a scene: the bars of the variants.
SPDX-License-Identifier: BSD-2-Clause"""
from ..compare import Change, Seeded, base_of, seeded_run, within_seeds
from ..rows import mark, own_options
from ..words import fixed, signed
from .context import sweep

PRIOR = "factorised costs at least 10 % more rate"
BARS = (
    ("concat", "bank against concat", "bank better"),
    ("inr_paper", "bank against inr, a network as large as the paper's (8 layers of 256)",
     "bank better"),
    ("inr_paper",
     "the same inr against the bank, trained as long as preset fast does, which takes less time",
     "bank better", "whole_long"),
    ("inr", "bank against inr, layers as wide as F_deform's (the paper has no such row)",
     "bank better"),
    ("factorised_flat",
     "inr prior against factorised prior, components independent as in the paper's", PRIOR),
    ("factorised_flat_auto",
     "the same two priors, both with the choice of capacity, as by default", PRIOR),
    ("factorised", "inr prior against factorised prior that keeps the autoregression (the paper "
                   "has no such row)", PRIOR),
    ("factorised_auto", "inr prior against factorised prior with autoregression, both with the "
                        "choice of capacity, as by default", PRIOR),
    ("factorised_long", "inr prior against factorised prior with autoregression, both trained as "
                        "long as preset fast does", PRIOR),
    ("noactive", "no activation", "costs rate or quality"),
    ("noprogress", "no progressive training", "costs quality"),
    ("static", "no deformation, nor activation, as in the paper's row",
     "far worse (here: at least 1 dB)"),
    ("nomotion", "no deformation, all else kept (the paper has no such row)", "worse"),
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
        variant_bar(report, scene, *one)
    for one in RECIPE_BARS:
        recipe_bar(report, scene, *one)


def variant_bar(report, scene, variant, what, limit, against=None):
    """against: a variant whose steps take much less time, with the core minutes of training of the
    largest files of both in the words; by default the variant's base."""
    runs, base = report.runs, against or base_of(variant)
    if against:
        what += " (" + " against ".join(minutes(runs.first(scene, one))
                                        for one in (against, variant)) + " core minutes)"
    what = f"{scene}: {what}"
    how = sweep(f"'{scene}-{variant}-*' '{scene}-{base}-*'")
    change = Change(runs, scene, variant, base)
    if not change.runs or not runs.is_complete(scene, variant) or not runs.is_complete(scene, base):
        report.bars.add(1, what, limit, "", None, how)
        return
    within = within_seeds(runs, scene, change)
    seeded = Seeded(runs, scene, variant)
    rows = mark(runs.of(scene, variant) + runs.of(scene, base))
    measured = (f"`{own_options(runs, runs.first(scene, variant))}`: {rate_text(change)}, "
                f"PSNR at equal bytes {signed(change.psnr, 2, ' dB')}; nearest "
                f"{change.near_words()}{rows}{'; within seeds' if within else ''}")
    if seeded.changes:
        measured += (f"; at {len(seeded.changes)} seeds {seeded.by_seed()}, mean "
                     f"{seeded.mean_text()} dB{seeded.mark()}")
    report.bars.add(1, what, limit, measured, is_met(variant, change, within, seeded), how)


def rate_text(change):
    """BD-rate; where there is none, the rate at equal PSNR, which a single run has."""
    if change.bd_rate is not None or change.rate is None:
        return f"BD-rate {change.bd_rate_text()}"
    return f"BD-rate -, rate at equal PSNR {signed(change.rate, 1, ' %')}"


def minutes(run):
    seconds = run.number("cpu_s")
    return fixed(None if seconds is None else seconds / 60, 0)


def is_met(variant, change, within, seeded):
    """Another prior begins where the whole method's stage 1 ends: seeds do not come between."""
    if variant.startswith("factorised"):
        return "?" if change.bd_rate is None else change.bd_rate >= 10
    if within:
        return seeded.is_worse()
    if variant == "static":
        return (change.near_psnr if change.psnr is None else change.psnr) <= -1
    return "?" if change.worse is None else change.worse


def recipe_bar(report, scene, changed, what, limit, least):
    runs = report.runs
    run = seeded_run(runs, scene, "recipe_" + changed, 1)
    if not run.in_group("recipe"):
        return
    seeded, measured, ok = Seeded(runs, scene, "recipe_" + changed), "", None
    if seeded.changes:
        measured = (f"`{own_options(runs, run)}`: PSNR at equal bytes, "
                    f"{len(seeded.changes)} seeds: {seeded.by_seed()}, "
                    f"mean {seeded.mean_text()} dB{seeded.mark()}")
        ok = seeded.is_worse()
        if ok is True:
            ok = -seeded.mean >= least
    report.bars.add(1, f"{scene}, the paper's recipe alone: {what}", limit, measured, ok,
                    sweep(f"recipe '{scene}-recipe-*'"))
