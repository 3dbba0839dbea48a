"""Rate and distortion of the whole method: bar 1, first half.
SPDX-License-Identifier: BSD-2-Clause"""
from ..compare import is_mixed
from ..plot import Plot, panels
from ..rows import mark
from ..words import cells
from .context import sweep

KB = "size of the file, kB (1000 bytes)"


def section(report):
    page, runs = report.tables, report.runs
    page.heading("Rate and distortion")
    page.prose("""The table shows the whole method at four λ, which share stage 1 of each scene. It
        is measured on held-out pictures rendered from decoded files. Decoding times are for one
        thread, frame rates for the run's threads; both were taken while other jobs of the sweep
        ran, and vary with them. *Moving* anchors are those with a temporal feature.""")
    for scene in report.scenes:
        page.heading(scene, 3)
        page.table("run", "λ", "PSNR dB", "SSIM", "SSIM_2", "MS-SSIM", "bytes", "anchors", "moving",
                   "Gaussians", "decode ms", "frames/s")
        for run in runs.of(scene, "whole"):
            if run.has():
                page.row(run.name(), run.weight, *cells(
                    run, "psnr:2 ssim:4 ssim2:4 ms_ssim:4 bytes anchors dynamic gaussians "
                         "decode_ms:1 render_fps:0"))
            else:
                page.row_missing(run.tag, run.weight)
    chart(report)
    bar(report)


def is_monotone(runs, scene):
    """Do bytes and PSNR fall with every step of lambda? None when a run is missing, or the present
    sources made only some of them."""
    whole = runs.of(scene, "whole")
    if len(whole) < 4 or not runs.is_complete(scene, "whole") or is_mixed(whole):
        return None
    return all(b.count("bytes") < a.count("bytes") and b.count("psnr") < a.count("psnr")
               for a, b in zip(whole, whole[1:]))


def bar(report):
    words = {None: "not run yet", True: "yes", False: "no"}
    falls = {scene: is_monotone(report.runs, scene) for scene in report.scenes}
    known = list(falls.values())
    ok = False if False in known else True if known and None not in known else None
    rows = [run for scene in report.scenes for run in report.runs.of(scene, "whole")]
    report.bars.add(1, "PSNR over bytes at four λ: " + ", ".join(report.scenes),
                    "PSNR and bytes fall with every step of λ",
                    ", ".join(f"{scene}: {words[fall]}" for scene, fall in falls.items())
                    + mark(rows), ok, sweep("rd"))


def chart(report):
    """A panel for each scene, two beside each other."""
    runs, scenes = report.runs, report.scenes
    if any(runs.present(scene, "whole") for scene in scenes):
        height, places = panels(len(scenes), 320)
        with report.charts.open("rate", 900, height + 8, "PSNR over bytes of the whole method at "
                                "four λ, by scene") as svg:
            for scene, (left, top) in zip(scenes, places):
                plot = Plot()
                plot.curve(runs, scene, "whole", "the whole method", report.styles.colour(scene),
                           report.styles.marker(scene), notes=True)
                plot.draw(svg, left, top, 450, 316, scene, KB, "PSNR, dB")
    show(report, report.tables)


def show(report, page):
    page.chart(report.charts, "rate", "PSNR over bytes, whole method, by scene; numbers at the "
               "points are λ; the axes differ")
