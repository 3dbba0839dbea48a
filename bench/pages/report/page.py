"""Puts the report together: a page to read, and one of all tables behind it.
SPDX-License-Identifier: BSD-2-Clause"""
from ..rows import mark
from ..words import Page, cells, fixed
from . import (bytes, estimate, findings, kept, lives, pictures, points, precision, progress, rate,
               seeds, singles, speed, variant_bars, variants)
from .context import Report

SHOWN = "kitchen-whole-2"   # the run of the headline and of the picture
MAIN_BITS = 48              # of the position of an anchor in profile Main (spec 8)


def write(runs, charts, results, pages):
    """{name of a file: text}, with charts drawn."""
    report = Report(runs, charts, results, pages)
    rate.section(report)
    variants.section(report)
    variant_bars.add_bars(report)
    singles.medium_section(report)
    singles.tint_section(report)
    singles.still_section(report)
    points.section(report)
    speed.section(report)
    bytes.section(report)
    lives.section(report)
    estimate.section(report)
    kept.section(report)
    precision.section(report)
    seeds.section(report)
    seeds.seeded_section(report)
    seeds.recipe_section(report)
    progress.section(report)
    pictures.sheet_section(report)
    pictures.command_section(report)
    return {"report.md": report_text(report), "report-tables.md": tables_text(report)}


def tables_text(report):
    head = Page()
    head.heading("All tables of the report", 1)
    head.prose("""`make report` writes this page from [sweep.csv](sweep.csv) and the pages that it
        names; `make sweep` makes the rows. [report.md](report.md) says what the tables show.""")
    head.prose(report.runs.summary() + ".")
    head.heading("Bars")
    head.prose("""The bars are those of the method, by number. "Not run yet" stands wherever a run
        is missing, "undecided" where the rows neither meet nor miss a bar. A bar about a part
        of the method (1) is judged by BD-rate or PSNR at equal bytes, over several seeds where one
        cannot decide, on every scene in which something moves and that has rows of both sides. It
        is met if all of these scenes meet it, and if they are at least two with more than one
        held-out camera in all; it is missed if one of them misses it.""")
    head.prose(report.bars.summary())
    report.bars.show(head, "command, then `make report`")
    head.say()
    return head.text() + report.tables.text()


# ---- the page to read ----

def report_text(report):
    page = Page()
    page.heading("Evaluation of the method", 1)
    headline(report, page)
    findings.section(report, page)
    findings.open_section(report, page)
    page.heading("Rate and distortion")
    page.prose("""The whole method at four λ, measured on held-out pictures rendered from decoded
        files ([tables](report-tables.md#rate-and-distortion),
        [bytes by syntax element](report-tables.md#bytes-by-syntax-element)).""")
    rate.show(report, page)
    speed_section(report, page)
    picture_section(report, page)
    page.heading("What each part is worth")
    page.prose("""Each variant is the whole method with one thing changed, trained separately
        ([tables](report-tables.md#one-thing-changed)).""")
    variants.show_overview(report, page)
    notes_section(report, page)
    return page.text()


def headline(report, page):
    run = report.runs.find(SHOWN)
    if run.has():
        speeds = kept.render_speeds(report)
        rows = [one for _, one in precision.step_runs(report.runs, run.scene)]
        ms = precision.median_ms(report.runs, run.scene, "integer")
        page.prose(f"""A file of {run.count('bytes') / 1000:.0f} kB reproduces the moving scene
            `kitchen`, as a held-out camera sees it, at {fixed(run.number('psnr'), 2)}
            dB{mark([run])} (PSNR), and decodes on one thread in {fixed(ms, 0)} ms{mark(rows)}
            (median of {precision.steps_of(report.runs, run.scene)})."""
            + (f" Two threads render 100,000 moving Gaussians at 960x536 at {speeds[0][1]:.1f} "
               "frames/s ([render.md](render.md))." if speeds else ""))
    page.prose("""This report measures rate, quality, speed and the worth of each part of the method
        on synthetic and real scenes, and says which [bars are
        missed](#what-was-promised-and-not-met). `make report` writes it from the rows of
        [sweep.csv](sweep.csv), which `make sweep` makes; [report-tables.md](report-tables.md) holds
        all tables and the commands behind them.""")
    page.prose(report.runs.summary() + "." + older_profile(report.runs.all))


def older_profile(runs):
    """Sentences where the older rows are of profile Main, and no other row is."""
    rows = [run for run in runs if run.has()]
    if not mark(rows) or any((run.position_bits() == MAIN_BITS) != run.is_old() for run in rows):
        return ""
    return """ The files of rows marked † are of profile Main, and were trained with the presets of
        earlier sources; the others are of profile Compact. No number compares the two kinds, and
        the commands behind marked rows make other files today."""


def speed_section(report, page):
    page.heading("Speed against accuracy")
    page.prose("""Every preset at its own λ and capacity (`--capacity fixed`). Core minutes are
        those of all threads together. The last column is the time to decode the whole file on one
        thread and to render one picture with the run's threads ([all columns and a
        chart](report-tables.md#speed-against-accuracy)).""")
    speed.show_training(report, page)
    page.table("run", "PSNR dB", "bytes", "core minutes", "decode + picture ms")
    for _, run in speed.preset_runs(report.runs):
        if run.has():
            page.row(run.name(), *cells(run, "psnr:2 bytes"), fixed(run.count("cpu_s") / 60, 1),
                     fixed(run.picture_ms(), 1))
        else:
            page.row_missing(run.tag)


def picture_section(report, page):
    page.heading("Pictures")
    page.prose("""Each sheet shows ground truth, rendering and error (5 times) of four
        held-out pictures; the rendering is from the decoded file ([all
        columns](report-tables.md#pictures)).""")
    if report.runs.find(SHOWN).has():
        page.say()
        page.say(f"![Ground truth, rendering and error of {SHOWN}](sheets/{SHOWN}.jpg)")
    page.table("sheet", "changed", "PSNR dB", "SSIM", "bytes")
    pictures.sheet_rows(report.runs, page, "psnr:2 ssim:4 bytes")


def notes_section(report, page):
    """What is written by hand."""
    page.heading("Notes")
    page.say()
    notes = kept.page_lines(report, "report-notes.md")
    for line in notes or ["None yet."]:
        page.say(line)
