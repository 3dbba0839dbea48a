"""How long anchors are active: bar 6. Numbers and pictures are by bench/spans.
SPDX-License-Identifier: BSD-2-Clause"""
import os

from ..bars import First
from ..compare import is_mixed, of_one_encoder
from ..rows import mark
from ..stacks import Stacks
from ..words import percent
from .context import sweep

# Shares in the paper: up to 0.2, between, 0.8 and more; percent.
PAPER = {"Steak": (97, 0, 3), "Banana": (85, 6, 9), "Broom": (47, 35, 18)}
COLOURS = ("#cccccc", "#56b4e9", "#d55e00")
# kitchen is the fast scene (a ball crosses it within a few frames), dog the slow one. What the
# paper's table shows by names of scenes is measured in the pictures of a camera that stands still:
# short lives belong where pixels change, and nowhere else.
FAST, SLOW = "kitchen-whole-2", "dog-whole-2"
# The fast and the slow scene as bar 6 first had them.
FIRST_FAST, FIRST_SLOW = "walk-whole-2", "kitchen-whole-2"


def section(report):
    page = report.tables
    page.heading("How long anchors live")
    page.prose("""The table shows the share of anchors by span a_f − a_s, as `bench/spans FILE.ted4
        SCENE DOWNSCALE PICTURE.png` prints it, for the whole method at λ 0.002. In the paper the
        shares are 3 / 0 / 97 % for Flame Steak (slow), 9 / 6 / 85 % for Banana and 18 / 35 / 47 %
        for Broom (fast). *Light by short lives* is the share of a pixel's light that comes from
        anchors with spans up to 0.2, over all pictures of the held-out camera, if it stands still.
        A pixel has changed at a time at which one of its channels differs from its median over time
        by more than 40 of 255.""")
    page.table("run", "up to 0.2", "between", "0.8 and more", "activation in the file",
               "pixels and times that have changed", "light by short lives there", "elsewhere")
    kept = [run for run in report.runs.all if run.keeps("spans")]
    for run in kept:
        span_row(page, run)
    there = [run for run in kept if run.text("span_short")]
    chart(report, there)
    pictures(report, there)
    bar(report)


def shares(run):
    return [100 * run.count("span_" + kind) for kind in ("short", "between", "long")]


def span_row(page, run):
    if not run.text("span_short"):
        page.row_missing(run.name())
        return
    page.row(run.name(), *(f"{share:.1f} %" for share in shares(run)),
             "yes" if run.count("activation") else "no: every span is 1",
             *(percent(run.number(name), 1) for name in ("changed", "short_changed", "short_same")))


def chart(report, there):
    """Columns in order of what lives long; the paper's three stand beside ours."""
    if there:
        stacks = Stacks(["0.8 and more", "between", "up to 0.2"], COLOURS)
        for run in there:
            stacks.column(run.scene, list(reversed(shares(run))))
        stacks.column("", [])
        for name, values in PAPER.items():
            stacks.column(name, values)
        title = "Share of anchors by activation span"
        with report.charts.open("spans", 900, 348, title) as svg:
            stacks.draw(svg, 0, 4, 740, 340, title, "ours by scene; right of the gap the paper's: "
                        "Flame Steak (slow), Banana (medium), Broom (fast)",
                        "share of anchors, %", share=True)
            stacks.legend(svg, 752, 46)
    report.tables.chart(report.charts, "spans", "Share of anchors by activation span")


def picture_path(report, run):
    return f"{report.results}/charts/spans-{run.tag}.jpg"


def pictures(report, there):
    page = report.tables
    there = [run for run in there if os.path.exists(picture_path(report, run))]
    if there:
        page.prose("""Each picture shows a held-out camera at the first, middle and last time.
            Below, the same Gaussians have the colour of their anchor's span: blue 0, white one
            half, red 1 (the strip is the scale), and darker where the Gaussian is dark.""")
    for run in there:
        page.say()
        page.say(f"![Spans, {run.tag}](charts/spans-{run.tag}.jpg)")


def bar(report):
    fast, slow = report.runs.find(FAST), report.runs.find(SLOW)
    text, ok = "", None
    if fast.text("short_changed") and slow.text("span_short"):
        ok = (fast.count("span_short") > slow.count("span_short")
              and fast.count("short_changed") >= 10 * fast.count("short_same")
              and all(os.path.exists(picture_path(report, run)) for run in (fast, slow)))
        text = (f"fast (kitchen): {shares_text(fast)}, light by short lives "
                f"{percent(fast.number('short_changed'), 1)} where it changes, "
                f"{percent(fast.number('short_same'), 1)} elsewhere; "
                f"slow (dog): {shares_text(slow)}")
        ok, text = of_one_encoder(ok, text, [fast, slow])
    report.bars.add(6, "activation spans up to 0.2 / between / 0.8 and more, and heat maps",
                    "short spans where objects come and go (light by short lives at least ten "
                    "times that elsewhere); more of them in the fast scene", text, ok,
                    sweep(f"{FAST} {SLOW}"), first_bar(report))


def shares_text(run):
    return " / ".join(f"{share:.1f}" for share in shares(run)) + " %"


def first_bar(report):
    """The bar as it first was; None while a run is missing."""
    fast, slow = report.runs.find(FIRST_FAST), report.runs.find(FIRST_SLOW)
    if not fast.text("span_short") or not slow.text("span_short"):
        return None
    return First("more short spans and fewer long ones in the fast scene, then walk, than in the "
                 "slow one, then kitchen",
                 f"fast (walk): {shares_text(fast)}; slow (kitchen): {shares_text(slow)}"
                 + mark([fast, slow]),
                 "?" if is_mixed([fast, slow]) else
                 fast.count("span_short") > slow.count("span_short")
                 and fast.count("span_long") < slow.count("span_long"))
