"""The spread that the seed alone makes: bar 11; and small differences over seeds.
SPDX-License-Identifier: BSD-2-Clause"""
from ..bars import DELIVERED
from ..compare import is_mixed, seed_spread, whole_run
from ..plot import Plot, panels
from ..rows import mark
from ..seeded import Seeded, seeded_variants
from ..words import cells, fixed, percent, signed
from .context import sweep
from .rate import KB
from .variants import PAPER


def seeded_scenes(runs):
    """(scene, runs by seed) of the scenes on which the whole method is wanted with more seeds."""
    found = []
    for scene in runs.scenes:
        count = 1
        while runs.wants(scene, f"seed{count + 1}", "seed"):
            count += 1
        if count > 1:
            found.append((scene, [whole_run(runs, scene, seed) for seed in range(1, count + 1)]))
    return found


def section(report):
    page, runs = report.tables, report.runs
    page.heading("Seeds")
    page.prose("""The same command is run with seeds 1, 2, 3 and so on. The spread is the largest
        minus the smallest value of the first three.""")
    page.table("scene", "run", "PSNR dB", "SSIM", "bytes", "anchors")
    scenes, texts = seeded_scenes(runs), []
    for scene, by_seed in scenes:
        for run in by_seed:
            if run.has():
                page.row(scene, run.name(), *cells(run, "psnr:3 ssim:4 bytes anchors"))
            else:
                page.row_missing(scene, run.tag)
        spread = seed_spread(runs, scene)
        if spread:
            page.row(scene, "**spread**", fixed(spread["psnr"], 3), fixed(spread["ssim"], 4),
                     f"{spread['bytes']:.0f} ({spread['share']:.2f} %)",
                     f"{spread['anchors']:.0f}")
            texts.append(f"{scene}: {spread['psnr']:.3f} dB, {spread['share']:.2f} % of bytes")
    chart(report, scenes)
    rows = mark([run for _, by_seed in scenes for run in by_seed])
    report.bars.add(11, "three seeds on one scene", "spread of PSNR and bytes reported",
                    "; ".join(texts) + rows if texts else "", DELIVERED if texts else None,
                    sweep("seed kitchen-whole-2 fair-whole-2"))


def chart(report, scenes):
    """A panel for each scene with rows of other seeds: the seeds on top of the curve of the whole
    method, so that their spread is seen beside what λ does."""
    scenes = [(scene, by_seed) for scene, by_seed in scenes
              if any(run.has() for run in by_seed[1:])]
    if scenes:
        height, places = panels(len(scenes), 330)
        with report.charts.open("seeds", 900, height + 8,
                                "Seeds beside the curve of the whole method") as svg:
            for (scene, by_seed), (left, top) in zip(scenes, places):
                plot = Plot()
                series = plot.series("other seeds", "#d55e00", "diamond", "-")
                for run in by_seed[1:]:
                    if run.has():
                        series.point(run.count("bytes") / 1000, run.number("psnr"))
                plot.curve(report.runs, scene, "whole", "seed 1, four λ", "#0072b2", "circle",
                           notes=True)
                plot.draw(svg, left, top, 450, 322, scene, KB, "PSNR, dB")
    report.tables.chart(report.charts, "seeds", "Seeds at λ 0.002 beside what λ does")


def seeded_section(report):
    page, runs = report.tables, report.runs
    page.heading("Small differences over seeds", 3)
    page.prose("""Variants that differ from the whole method by no more than seeds do are trained
        with several seeds, each against the whole method at the same seed, λ 0.002. The table shows
        PSNR at equal bytes, along the curve of the whole method, and the mean with its standard
        error. Negative numbers mean that the variant is worse. *p* is the two-sided p-value of
        Student's t-test: how often chance alone makes a mean as far from zero. *Alone* is the
        verdict if no other comparison is made, *inconclusive* where p is above 5 %. *Together* is
        the verdict if all comparisons of this table and the next are judged together, so that the
        chance that any of them is wrong is at most 5 % (Holm's correction, two-sided). """
               + report.family.holds())
    page.table("scene", "variant", "by seed", "mean dB", "p", "alone", "together")
    for scene, variant in seeded_variants(runs, "seeded"):
        seeded = Seeded(runs, scene, variant)
        if seeded.changes:
            page.row(scene, variant + seeded.mark(), seeded.by_seed(), seeded.mean_text(),
                     *verdicts(report, seeded))
        else:
            page.row_missing(scene, variant)


def verdicts(report, seeded):
    """How often chance makes such a mean, the verdict alone, and that among all comparisons."""
    words = {True: "worse", False: "better", "?": "inconclusive"}
    return (percent(seeded.chance, 1), words[seeded.is_worse_alone()],
            words[report.family.is_worse(seeded)])


def recipe_section(report):
    """The recipe with one thing changed: what that part of the method is worth where neither
    seeding nor the initial points do its work."""
    page, runs = report.tables, report.runs
    page.heading("The paper's recipe alone", 3)
    page.prose("""This is the same comparison without multi-view seeding (sprouts), transients and
        probe. What else the paper does not have stays, as said [above](#one-thing-changed). Each
        seed is compared with the recipe at the same seed and λ, as in the paper's table: in PSNR
        and bytes, with their means, and in the mean of PSNR at equal bytes, along the recipe's own
        curve of three λ, with its standard error.""")
    page.table("scene", "changed", "by seed", "mean", "at equal bytes", "p", "alone", "together",
               "paper")
    for scene, variant in seeded_variants(runs, "recipe"):
        if variant != "recipe":
            recipe_row(report, scene, variant)


def recipe_row(report, scene, variant):
    page, runs, changed = report.tables, report.runs, variant[len("recipe_"):]
    seeded = Seeded(runs, scene, variant)
    if not all(run.has() and base.has() and not is_mixed([run, base])
               for run, base in seeded.pairs):
        page.row_missing(scene, changed)
        return
    both = [(run.count("psnr") - base.count("psnr"),
             100 * (run.count("bytes") / base.count("bytes") - 1)) for run, base in seeded.pairs]
    n = len(both)
    mean = (sum(psnr / n for psnr, _ in both), sum(rate / n for _, rate in both))
    page.row(scene, changed + seeded.mark(), "; ".join(change_text(pair) for pair in both),
             change_text(mean), seeded.mean_text() + " dB" if seeded.changes else "-",
             *(verdicts(report, seeded) if seeded.changes else "---"), PAPER.get(changed, ""))


def change_text(change):
    return signed(change[0], 2, " dB") + ", " + signed(change[1], 1, " %")
