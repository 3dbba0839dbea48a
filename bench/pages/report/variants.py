"""The whole method with one thing changed: bar 1, second half.
SPDX-License-Identifier: BSD-2-Clause"""
from ..compare import (Change, near_words, nearest, psnr_change, rate_change,
                       within_seeds)
from ..dots import Dots
from ..plot import Plot, panels
from ..rows import mark, own_options
from ..svg import COLOURS, MARKERS
from ..words import cells, signed
from .rate import KB

FAMILIES = {
    "Deformation": "concat inr inr_paper nomotion static plain",
    "Time": "noactive noprogress notempmask hardmask nosprouts recipe",
    "Prior": "factorised factorised_flat factorised_auto factorised_flat_auto",
    "Rate": "noautoreg nooffmask linscale",
    "Colour": "noview fullview nocolour",
    "Other": "",
}
# The paper's table of ablations: Neu3D, highest rate, at the same lambda; the prior's figure is a
# BD-rate.
PAPER = {
    "concat": "−0.98 dB, −0.5 % bytes",
    "inr_paper": "−2.53 dB, +141 % bytes (a far larger network)",
    "noactive": "−0.25 dB, +5.7 % bytes",
    "noprogress": "−0.81 dB, −14.7 % bytes",
    "static": "−3.70 dB, +14 % bytes (Scaffold-GS without deformation, before compression)",
    "factorised_flat": "+25 % bytes (the INR prior saves 20 %; its factorised prior is one density "
                       "per type)",
}


def section(report):
    page, runs = report.tables, report.runs
    page.heading("One thing changed")
    explain(page)
    for scene in runs.scenes:
        if variants_of(runs, scene):
            table(report, scene)
            scene_chart(report, scene)
    overview(report)


def explain(page):
    page.prose("""Each variant is trained separately and measured on its own file. *Rate at equal
        PSNR* and *PSNR at equal bytes* compare it with the curve of the whole method at four λ,
        which is interpolated linearly, logarithm of bytes over PSNR; "-" stands where that curve
        does not reach. *Nearest* is the point of the whole method that is nearest in PSNR, with the
        differences from it. *BD-rate* is the mean change of rate over the PSNR that both curves
        share; bars, charts and texts compare rates by it. With four points on each curve it is
        Bjontegaard's, on cubics; with fewer it is marked "lines" and computed exactly on straight
        lines. Both curves go through the same λ, because a straight line between distant points
        lies below a bent curve. Bold rows hold the BD-rate, and the means of the other differences
        over the variant's runs. Positive rates and negative PSNR mean that the variant is worse.
        *Paper* is the paper's table of ablations: Neu3D at its highest rate, same λ. *Within seeds*
        means that PSNR at equal bytes differs by less than the spread of three seeds of the whole
        method on that scene.""")
    page.prose("""*factorised_flat* has one Gaussian per component for all anchors; *factorised*
        also keeps the autoregression. *inr* has layers as wide as those of the whole method's
        F_deform, *inr_paper* as many and as wide as the paper's. *hardmask* gives the temporal mask
        ten times its weight. *recipe* leaves out multi-view seeding (sprouts), short-lived initial
        points (transients) and the static-scene test (probe). It is not all of the [paper's
        recipe](../doc/switches.md#the-papers-recipe): profile Compact, the rule that stops anchors,
        dropout, and the correction of poses and exposures stay. Only the rows *_auto* choose their
        capacity; they are compared with the whole method with that choice, *whole_auto*. The
        numbers of steps are among the [options](#commands) behind the rows.""")


def variants_of(runs, scene):
    return [variant for variant in runs.variants if runs.wants(scene, variant, "variant")]


def table(report, scene):
    page = report.tables
    page.heading("Variants on " + scene, 3)
    page.table("run", "changed", "λ", "PSNR dB", "bytes", "rate at equal PSNR",
               "PSNR at equal bytes", "nearest", "BD-rate", "paper", "verdict")
    for variant in variants_of(report.runs, scene):
        rows(page, report.runs, scene, variant)


def rows(page, runs, scene, variant):
    for run in runs.of(scene, variant):
        changed = f"`{own_options(runs, run)}`"
        if run.has():
            page.row(run.name(), changed, run.weight, *cells(run, "psnr:2 bytes"),
                     signed(rate_change(runs, run), 1, " %"),
                     signed(psnr_change(runs, run), 2, " dB"), near_text(runs, run))
        else:
            page.row_missing(run.tag, changed, run.weight)
    change = Change(runs, scene, variant)
    if change.runs:
        page.row(f"**{variant}**", "", "", "", "", "",
                 signed(change.psnr, 2, " dB"), change.near_words(), change.bd_rate_text(),
                 PAPER.get(variant, ""), verdict(variant, change.worse)
                 + ("; within seeds" if within_seeds(runs, scene, change) else ""))


def near_text(runs, run):
    other = nearest(runs, run)
    if other is None:
        return "-"
    return other.tag + ": " + near_words(
        run.count("psnr") - other.count("psnr"),
        100 * (run.count("bytes") / other.count("bytes") - 1))


def verdict(variant, worse):
    if worse is None:
        return "undecided"
    if variant not in PAPER:
        return "worse" if worse else "better"
    return "worse, as in the paper" if worse else "better, **unlike the paper**: see the notes"


# ---- charts ----

def family_of(variant):
    """Variants that no family names are of the last one."""
    for name, members in FAMILIES.items():
        if variant in members.split():
            return name
    return "Other"


def scene_chart(report, scene):
    """A panel for each family that the scene has, each with the whole method's curve."""
    runs, variants = report.runs, variants_of(report.runs, scene)
    families = [name for name in FAMILIES if name in map(family_of, variants)]
    name = "variants-" + scene
    if any(runs.present(scene, variant) for variant in variants):
        height, places = panels(len(families), 342)
        with report.charts.open(name, 900, height + 4,
                                "PSNR over bytes of the variants on " + scene) as svg:
            for family, (left, top) in zip(families, places):
                plot = Plot()
                plot.curve(runs, scene, "whole", "whole", COLOURS[0], "circle")
                members = [variant for variant in variants if family_of(variant) == family]
                for k, variant in enumerate(members, 1):
                    plot.curve(runs, scene, variant, variant, COLOURS[k % 8], MARKERS[k % 8],
                               "6 4")
                plot.draw(svg, left, top, 450, 336, family, KB, "PSNR, dB")
    report.tables.chart(report.charts, name,
                        f"PSNR over bytes of the variants on {scene}; the axes differ")


def overview(report):
    """All variants at a glance: BD-rate and PSNR at equal bytes."""
    runs, dots = report.runs, Dots(report.styles)
    variants = [variant for variant in runs.variants
                if any(runs.wants(scene, variant, "variant") for scene in runs.scenes)]
    found = 0
    for variant in variants:
        dots.row(variant)
        found += variant_dots(runs, dots, variant)
    if found:
        with report.charts.open("variants", 900, dots.height() + 96,
                                "Variants against the whole method") as svg:
            dots.legend(svg, 180, 14)
            dots.draw(svg, 170, 40, 340, 1, "BD-rate, % (right: worse)", names=True)
            dots.draw(svg, 530, 40, 360, 2, "PSNR at equal bytes, dB (left: worse)")
    report.tables.heading("All variants", 3)
    show_overview(report, report.tables)


def show_overview(report, page):
    page.chart(report.charts, "variants", "Variants against the whole method, by scene")


def variant_dots(runs, dots, variant):
    """Panel 1: rate; panel 2: PSNR. How many scenes had runs."""
    changes = [(scene, Change(runs, scene, variant)) for scene in runs.scenes
               if runs.wants(scene, variant, "variant")]
    found = sum(change.runs > 0 for _, change in changes)
    for panel, number in ((1, lambda change: change.bd_rate), (2, lambda change: change.psnr)):
        for scene, change in changes:
            dots.value(panel, number(change), scene)
        if all(number(change) is None for _, change in changes):
            dots.word(panel, "the curve does not reach" if found else "not run yet")
    return found
