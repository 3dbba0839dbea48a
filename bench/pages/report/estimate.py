"""The rate that training estimates against the bytes of the file: bar 7.
SPDX-License-Identifier: BSD-2-Clause"""
from ..dots import Dots
from ..rows import mark
from ..words import signed
from .context import sweep


def worst_of(pairs):
    """The (error, run) with the largest error; None without any."""
    return max(pairs, key=lambda pair: abs(pair[0]), default=None)


def section(report):
    page, runs = report.tables, report.runs
    page.heading("Rate estimated in training against the file")
    page.prose("""`estimated_bits` of `ted4enc --json` is the trainer's formula on rounded symbols
        of all anchors; it is compared with the bytes of the attributes' substreams in the file. The
        table shows, for each variant, the run with the largest difference.""")
    page.table("variant", "runs", "estimated against file", "of run")
    dots, known, missing = Dots(report.styles, band=1), [], 0
    for variant in runs.variants:
        dots.row(variant)
        pairs = [(run.estimate_error(), run) for run in runs.all if run.variant == variant]
        pairs = [pair for pair in pairs if pair[0] is not None]
        for error, run in pairs:
            dots.value(1, error, run.scene)
        if pairs:
            worst = worst_of(pairs)
            page.row(variant, str(len(pairs)), signed(worst[0], 2, " %"), worst[1].name())
        else:
            missing += 1
            page.row_missing(variant)
        known += pairs
    chart(report, dots, known)
    bar(report, known, missing)


def chart(report, dots, known):
    if known:
        with report.charts.open("estimate", 900, dots.height() + 96,
                                "Estimated rate against the file") as svg:
            dots.legend(svg, 190, 16)
            dots.draw(svg, 190, 40, 670, 1, "estimated bits against those in the file, % (green: "
                      "the bar)", names=True)
    report.tables.chart(report.charts, "estimate",
                        "Estimated rate against the file, with a mark for each run")


def bar(report, known, missing):
    text, ok = "", None
    if known:
        worst, all_variants = worst_of(known)[0], len(report.runs.variants)
        text = (f"at most {signed(worst, 2, ' %')} in {all_variants - missing} of {all_variants} "
                "variants" + mark([run for _, run in known]))
        ok = False if abs(worst) > 1 else None if missing else True
    report.bars.add(7, "rate estimated in training against the file, every variant", "within 1 %",
                    text, ok, sweep())
