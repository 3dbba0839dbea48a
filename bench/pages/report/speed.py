"""What time buys: PSNR over training time by preset, and over the time to decode and draw: bar 5.
SPDX-License-Identifier: BSD-2-Clause"""
from ..bars import DELIVERED
from ..logs import read_lines
from ..plot import Plot, panels
from ..rows import mark
from ..words import cells, fixed
from .context import sweep

# Of each preset: colour and marker.
PRESETS = {
    "draft": ("#56b4e9", "down"), "fast": ("#0072b2", "circle"), "medium": ("#009e73", "square"),
    "slow": ("#e69f00", "triangle"), "paper": ("#d55e00", "diamond"),
}
PREVIEW = 6     # dB below the end, from which the log's previews are drawn


def preset_runs(runs):
    """(preset, run) of all that the table wants, by scene."""
    return [(preset, runs.first(scene, preset)) for scene in runs.scenes for preset in PRESETS
            if runs.wants(scene, preset, "preset")]


def section(report):
    page, runs = report.tables, report.runs
    page.heading("Speed against accuracy")
    page.prose("""The table shows every preset at its own λ and capacity (`--capacity fixed`, as in
        all rows of the sweep but *_auto*; [capacity.md](capacity.md) says what choosing it costs
        and gains). Core seconds are those of all threads together, stage 1 included; they can be
        compared whatever else ran. Seconds are of wall clock. The last column is the time to decode
        the whole file on one thread and then to render one picture with the run's threads, while
        the sweep's other jobs ran; [render.md](render.md) and [decode.md](decode.md) are of a quiet
        machine.""")
    page.table("run", "preset", "core s", "of it stage 1", "s", "jobs x threads", "PSNR dB",
               "bytes", "decode ms", "frames/s", "decode + picture ms")
    wanted = preset_runs(runs)
    for preset, run in wanted:
        if run.has():
            page.row(run.name(), preset, *cells(
                run, "cpu_s:0 stage1_cpu_s:0 train_s:0 team psnr:2 bytes decode_ms:1 "
                     "render_fps:0"), fixed(run.picture_ms(), 1))
        else:
            page.row_missing(run.tag, preset)
    training_chart(report)
    show_training(report, page)
    picture_chart(report)
    drawn = [run for _, run in wanted]
    drawn += [run for scene in report.scenes for run in runs.of(scene, "whole")]
    there = sum(run.has() for run in drawn)
    report.bars.add(5, "speed against accuracy", "PSNR over training time of every preset, over "
                    "decode-plus-render time; bytes by syntax element over λ",
                    f"{there} of {len(drawn)} runs drawn{mark(drawn)}: "
                    "[one](charts/training.svg), [two](charts/picture.svg), "
                    "[three](charts/bytes.svg)" if there else "",
                    DELIVERED if drawn and there == len(drawn) else None, sweep("preset rd"))


def show_training(report, page):
    page.chart(report.charts, "training", "PSNR over training time for every preset; marks: "
               "held-out pictures from the decoded file; lines: the log's preview, from 6 dB below "
               "its end")


def training_chart(report):
    """A panel for each scene that has presets."""
    wanted = preset_runs(report.runs)
    scenes = list(dict.fromkeys(run.scene for _, run in wanted))
    if not any(run.has() for _, run in wanted):
        return
    height, places = panels(len(scenes), 360)
    with report.charts.open("training", 900, height + 8,
                            "PSNR over training time by preset") as svg:
        for scene, (left, top) in zip(scenes, places):
            plot = Plot()
            for preset in PRESETS:
                if report.runs.of(scene, preset):
                    training_series(report, plot, report.runs.first(scene, preset), preset)
            plot.draw(svg, left, top, 450, 352, scene, "training time, core seconds", "PSNR, dB",
                      log_x=True)


def training_series(report, plot, run, preset):
    """A line from the log, its seconds turned into core seconds; a large mark for the decoded
    file."""
    colour, marker = PRESETS[preset]
    end = plot.series(preset, colour, marker, "-")
    if not run.has():
        return
    end.point(run.number("cpu_s"), run.number("psnr"))
    lines = read_lines(f"{report.results}/logs/{run.tag}.jsonl")
    if len(lines) < 2 or run.count("train_s") <= 0:
        return
    scale = run.count("cpu_s") / run.count("train_s")
    series = plot.series("", colour, "none")
    for line in lines:
        if line["psnr"] is not None and line["psnr"] > (lines[-1]["psnr"] or 0) - PREVIEW:
            series.point(line["seconds"] * scale, line["psnr"])


def picture_chart(report):
    """A series per scene for the λ of the whole method, another for its presets."""
    plot, runs = Plot(), report.runs
    for scene in report.scenes:
        series = plot.series(f"{scene}, four λ", report.styles.colour(scene),
                             report.styles.marker(scene))
        for i, run in enumerate(runs.of(scene, "whole")):
            if run.has():
                series.point(run.picture_ms(), run.number("psnr"), run.weight if i == 0 else "")
    for scene in report.scenes:
        series = plot.series(f"{scene}, presets", report.styles.colour(scene), "ring", "-",
                             above=True)
        for preset in PRESETS:
            run = runs.first(scene, preset)
            if run.in_group("preset") and run.has():
                series.point(run.picture_ms(), run.number("psnr"), preset)
    if not plot.is_empty():
        with report.charts.open("picture", 900, 488,
                                "PSNR over the time to decode a file and draw a picture") as svg:
            plot.draw(svg, 0, 4, 900, 480, "Decoding a file and drawing a picture",
                      "time to decode the file (one thread) and draw one picture, ms",
                      "PSNR, dB", log_x=True)
    report.tables.chart(report.charts, "picture", "PSNR over the time to decode a file and draw "
                        "one picture; notes: least λ, preset")
