"""How loss, PSNR, anchors and bytes go over time, from thinned logs: bench/logs/TAG.jsonl.
SPDX-License-Identifier: BSD-2-Clause"""
from ..logs import read_lines
from ..plot import Plot

DASHES = ("", "7 4", "2 4", "9 4 2 4")


def section(report):
    page = report.tables
    page.heading("Training curves")
    page.prose("""The curves come from the logs that `ted4enc --log FILE` writes, thinned to about
        100 lines each in `bench/logs`: loss; PSNR on a few held-out pictures during training;
        anchors; estimated bytes (stage 2 only). Seconds are of wall clock, without
        what interruptions lost. The runs are those of the whole method at λ 0.002.""")
    logs = {scene: lines for scene in report.scenes if (lines := log_of(report, scene))}
    if logs:
        with report.charts.open("progress", 900, 672,
                                "Loss, PSNR, anchors and bytes over training time") as svg:
            panel(report, svg, logs, "loss", 0, 4, "Loss", "loss", 1)
            panel(report, svg, logs, "psnr", 450, 4, "Quality", "PSNR, dB", 1)
            panel(report, svg, logs, "anchors", 0, 340, "Anchors", "anchors, thousands", 1000)
            panel(report, svg, logs, "bytes", 450, 340, "Size", "estimated size, kB (1000 bytes)",
                  1000)
    page.chart(report.charts, "progress",
               "Loss, PSNR, anchors and estimated bytes over seconds of training")


def log_of(report, scene):
    """The log of the first run of the whole method on a scene that keeps one and has it."""
    for run in report.runs.present(scene, "whole"):
        if run.keeps("log"):
            lines = read_lines(f"{report.results}/logs/{run.tag}.jsonl")
            if lines:
                return lines
    return None


def panel(report, svg, logs, name, left, top, title, label, unit):
    plot = Plot()
    for scene, lines in logs.items():
        series = plot.series(scene, report.styles.colour(scene), "none",
                             DASHES[min(report.scenes.index(scene), 3)])
        for line in lines:
            value = line[name]
            if value is not None and (name != "bytes" or value > 0):
                series.point(line["seconds"], value / unit)
    plot.draw(svg, left, top, 450, 328, title, "time, s", label)
