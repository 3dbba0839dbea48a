"""Quantisation steps and precision of the entropy networks against bytes, PSNR and decode time:
bar 10.
SPDX-License-Identifier: BSD-2-Clause"""
import statistics

from ..bars import DELIVERED
from ..plot import Plot
from ..rows import mark
from ..words import counted, fixed, signed
from .context import sweep

STEPS = {"0.5": "steps0.5", "1": "whole", "2": "steps2", "4": "steps4"}
PRECISIONS = {"integer": "", "float32": "7 4", "float64": "2 4"}    # and their dashes


def step_runs(runs, scene):
    """(factor, run), at the lambda of the others."""
    return [(factor, runs.find(f"{scene}-{variant}-2")) for factor, variant in STEPS.items()]


def bytes_with(run, precision):
    """Bytes that the file would have with networks of that precision; None when not known."""
    bits = run.number(precision + "_bits")
    return None if bits is None else run.count("bytes") + (bits - run.count("integer_bits")) / 8


def ms_with(run, precision):
    """Milliseconds that decoding it would take."""
    networks = run.number(precision + "_ms")
    return None if networks is None else (run.count("decode_ms") - run.count("integer_ms")
                                          + networks)


def known_ms(runs, scene, precision):
    found = [ms_with(run, precision) for _, run in step_runs(runs, scene)]
    return [ms for ms in found if ms is not None]


def median_ms(runs, scene, precision):
    """Milliseconds to decode a file of a scene: the median over its quantisation steps, which
    hardly matter for it, because other work may have disturbed a row; None without rows."""
    known = known_ms(runs, scene, precision)
    return statistics.median(known) if known else None


def steps_of(runs, scene):
    """What it is the median of, in words."""
    return counted(len(known_ms(runs, scene, "integer")), "quantisation step")


def section(report):
    page, runs = report.tables, report.runs
    page.heading("Precision")
    page.prose("""The steps Q0 of features, scalings and offsets are multiplied by a factor, and a
        model is trained for each factor. The entropy model is evaluated in integers, as coded, or
        in floating point (`bench/rate_check FILE.ted4`). The table shows the bytes that the file
        would have with networks of that precision and the same coder, and the time to decode it on
        one thread, with the time of these networks in place of that of the integer ones. Pictures
        do not depend on the precision. Floating-point networks would not decode identically on
        another machine, which is why the coded ones are integers.""")
    page.table("run", "Q0 times", "PSNR dB", "bytes: integer", "float32", "float64",
               "decode ms: integer", "float32", "float64", "of it networks: integer", "float32",
               "float64")
    scenes = [scene for scene in runs.scenes if runs.wants(scene, "steps2", "precision")]
    wanted = [pair for scene in scenes for pair in step_runs(runs, scene)]
    for factor, run in wanted:
        precision_row(page, run, factor)
    chart(report)
    there = sum(run.number("float64_bits") is not None for _, run in wanted)
    texts = [precision_text(runs, scene) for scene in scenes]
    text = "; ".join(text for text in texts if text)
    if there:
        text = (f"{there} of {len(wanted)} runs drawn{mark([run for _, run in wanted])}: "
                "[precision](charts/precision.svg)" + (text and "; " + text))
    report.bars.add(10, "Q0 and network precision (float64, float32, integer as coded) against "
                    "bytes, PSNR and decode time", "one chart", text,
                    DELIVERED if wanted and there == len(wanted) else None,
                    sweep("precision rd"))


def precision_row(page, run, factor):
    if run.number("float64_bits") is None:
        page.row_missing(run.name(), factor)
        return
    page.row(run.name(), factor, fixed(run.number("psnr"), 2),
             *(fixed(bytes_with(run, p), 0) for p in PRECISIONS),
             *(fixed(ms_with(run, p), 1) for p in PRECISIONS),
             *(fixed(run.number(p + "_ms"), 1) for p in PRECISIONS))


def precision_text(runs, scene):
    """What integers cost a scene: bytes at factor 1, and time."""
    run = runs.find(scene + "-whole-2")
    ideal = bytes_with(run, "float64")
    if ideal is None:
        return ""
    ms = {precision: fixed(median_ms(runs, scene, precision), 0) for precision in PRECISIONS}
    return (f"{scene}: integers {signed(100 * (run.count('bytes') / ideal - 1), 3, ' %')} bytes "
            f"against float64, decoding {ms['integer']} ms (float32 {ms['float32']}, float64 "
            f"{ms['float64']}; medians of {steps_of(runs, scene)})")


def chart(report):
    """Four panels over the factor. Colour and marker tell the scene; solid the integers, dashed
    float32, dotted float64."""
    runs = report.runs
    scenes = [scene for scene in report.scenes if runs.wants(scene, "steps2", "precision")]
    if any(run.text("float64_bits") for scene in scenes for _, run in step_runs(runs, scene)):
        with report.charts.open("precision", 900, 688, "Steps and precision of the networks "
                                "against bytes, PSNR and decode time") as svg:
            panel(report, svg, scenes, ("integer",), 0, 4,
                  "Quality (the same for every precision)", "PSNR, dB",
                  lambda run, _: run.number("psnr"))
            panel(report, svg, scenes, ("integer",), 450, 4, "Size, integers as coded",
                  "kB (1000 bytes)", lambda run, _: run.count("bytes") / 1000)
            panel(report, svg, scenes, ("integer", "float32"), 0, 346,
                  "Size against networks in float64", "more bytes, %",
                  lambda run, p: 100 * (bytes_with(run, p) / bytes_with(run, "float64") - 1))
            panel(report, svg, scenes, PRECISIONS, 450, 346, "Time to decode, one thread", "ms",
                  ms_with)
    report.tables.chart(report.charts, "precision", "Steps Q0 (times a factor) and precision of "
                        "the entropy networks against PSNR, bytes and decode time")


def panel(report, svg, scenes, precisions, left, top, title, label, value):
    """value: of a run and a precision."""
    plot = Plot()
    for scene in scenes:
        for precision in precisions:
            is_integer = precision == "integer"
            series = plot.series(
                scene if len(precisions) == 1 else f"{scene} {precision}",
                report.styles.colour(scene), report.styles.marker(scene) if is_integer else "ring",
                PRECISIONS[precision])
            for factor, run in step_runs(report.runs, scene):
                if run.text("float64_bits"):
                    series.point(factor, value(run, precision))
    plot.draw(svg, left, top, 450, 338, title, "steps: Q0 times", label, log_x=True,
              ticks=" ".join(STEPS))
