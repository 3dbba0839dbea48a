"""The bars of the variants as they were first defined, each judged on today's rows: a function of
the runs and the scene, which returns a First, or None while a row is missing.
SPDX-License-Identifier: BSD-2-Clause"""
from ..bars import First
from ..compare import Change
from ..words import signed


def one_seed(runs, scene, variant, what):
    """Judged by PSNR at equal bytes at one seed, however small the difference."""
    change = Change(runs, scene, variant)
    if not change.runs:
        return None
    measured = (f"PSNR at equal bytes {signed(change.psnr, 2, ' dB')}; nearest "
                f"{change.near_words()}")
    return First(f"on {scene}: {what}, at one seed", measured,
                 "?" if change.worse is None else change.worse)


def concat(runs, scene):
    return one_seed(runs, scene, "concat", "bank better than concat")


def inr(runs, scene):
    return one_seed(runs, scene, "inr", "bank better than inr, layers as wide as F_deform's")


def inr_paper(runs, scene):
    return one_seed(runs, scene, "inr_paper",
                    "bank better than that inr, trained for as many steps")


def noprogress(runs, scene):
    return one_seed(runs, scene, "noprogress", "no progressive training costs quality")


def nomotion(runs, scene):
    """By PSNR at equal bytes, where the curve reaches."""
    change = Change(runs, scene, "nomotion")
    if not change.runs:
        return None
    loss = change.near_psnr if change.psnr is None else change.psnr
    return First(f"on {scene}: no deformation, all else kept: at least 1 dB worse, at one seed",
                 signed(loss, 2, " dB"), loss <= -1)


def prior(runs, scene):
    """By the mean of the rates at equal PSNR, each on straight lines."""
    change = Change(runs, scene, "factorised")
    if change.rate is None:
        return None
    return First(f"on {scene}: a factorised prior with autoregression, capacity fixed, with the "
                 "steps of most rows, by the mean of the rates at equal PSNR: at least 10 %",
                 signed(change.rate, 1, " %"), change.rate >= 10)
