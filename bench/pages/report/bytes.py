"""Bytes of the whole method's files by syntax element, over λ: bar 5.
SPDX-License-Identifier: BSD-2-Clause"""
from ..stacks import Stacks
from ..words import cells

ELEMENTS = "header nete netr bank positions masks feature scaling offset phi tau frame".split()
# Parts of a column, from its bottom, and what they add up.
PARTS = {
    "entropy networks": ("nete",), "networks, bank": ("netr", "bank"), "positions": ("positions",),
    "masks": ("masks",), "features": ("feature",), "scalings": ("scaling",),
    "offsets": ("offset",), "φ: motion": ("phi",), "τ: activation": ("tau",),
    "header, framing": ("header", "frame"),
}


def section(report):
    page, runs = report.tables, report.runs
    page.heading("Bytes by syntax element")
    page.prose("""The numbers are those of `ted4info FILE.ted4 --budget`. *Frames* are the bytes
        that frame chunks, tiles and the file.""")
    page.table("run", "λ", "all", "header", "entropy networks", "networks", "bank", "positions",
               "masks", "feature", "scaling", "offset", "φ", "τ", "frames")
    for scene in report.scenes:
        for run in runs.of(scene, "whole"):
            if run.has():
                page.row(run.name(), run.weight,
                         *cells(run, "bytes b_" + " b_".join(ELEMENTS)))
            else:
                page.row_missing(run.tag, run.weight)
    chart(report)


def chart(report):
    runs = report.runs
    scenes = [scene for scene in report.scenes if runs.present(scene, "whole")]
    if scenes:
        with report.charts.open("bytes", 900, (len(scenes) + 1) // 2 * 330 + 8,
                                "Bytes by syntax element over λ") as svg:
            for k, scene in enumerate(scenes):
                stacks = Stacks(list(PARTS))
                for run in runs.present(scene, "whole"):
                    stacks.column(run.weight, [sum(run.count("b_" + name) for name in names) / 1000
                                               for names in PARTS.values()])
                stacks.draw(svg, k % 2 * 370, k // 2 * 330 + 4, 370, 324, scene,
                            "λ, weight of the rate", "kB (1000 bytes)")
            stacks.legend(svg, 752, 46)
    report.tables.chart(report.charts, "bytes", "Bytes by syntax element over λ, by scene")
