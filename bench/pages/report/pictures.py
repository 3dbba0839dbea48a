"""Runs that keep a picture, and the commands of all runs.
SPDX-License-Identifier: BSD-2-Clause"""
from ..rows import own_options
from ..words import cells


def sheet_rows(runs, page, columns):
    """A row for each run that keeps a sheet, with these columns of its own."""
    for run in runs.all:
        if not run.keeps("sheet"):
            continue
        changed = own_options(runs, run)
        changed = changed and f"`{changed}`"
        if run.has():
            page.row(f"[{run.name()}](sheets/{run.tag}.jpg)", changed, *cells(run, columns))
        else:
            page.row_missing(run.tag, changed)


def sheet_section(report):
    page = report.tables
    page.heading("Pictures")
    page.prose("""Each sheet shows ground truth, rendering and error (5 times) of four
        held-out pictures; the rendering is from the decoded file.""")
    page.table("sheet", "changed", "PSNR dB", "SSIM", "MS-SSIM", "bytes", "training s",
               "jobs x threads", "anchors", "moving", "decode ms")
    sheet_rows(report.runs, page, "psnr:2 ssim:4 ms_ssim:4 bytes train_s:0 team anchors dynamic "
                                  "decode_ms:0")


def command_of(run):
    """Options: those that made the row, wanted ones where there is none."""
    folder = "" if run.where.startswith("own:") else "$TED4_DATA/"
    return f"`ted4enc {folder}{run.where} {run.text('options') if run.has() else run.options}`"


def command_section(report):
    page, runs = report.tables, report.runs
    page.heading("Commands")
    page.prose("""`make sweep` runs what is missing, `bench/sweep.sh PATTERN...` a part of it, and
        `make report` writes these pages. To make a row by hand, run its command with `-o
        FILE.ted4`, then `ted4eval FILE.ted4 SCENE --downscale N` (with its `--hold-out`), `ted4info
        FILE.ted4 --budget`, `bench/spans FILE.ted4` and `bench/rate_check FILE.ted4`. Scenes
        `own:NAME` are made by `ted4scene NAME -o FOLDER`. † marks rows that older sources made, and
        numbers that depend on such a row. [sweep.csv](sweep.csv) has all columns.""")
    if runs.strangers:
        page.prose(f"It holds {runs.strangers} rows that sweep.txt does not list; they are not "
                   "shown.")
    if runs.others:
        page.prose(f"It holds {runs.others} rows that other options than the wanted ones made; "
                   "they count as not run.")
    page.table("run", "command", "jobs x threads", "key")
    for run in runs.all:
        if run.has():
            page.row(run.name(), command_of(run), *cells(run, "team key"))
        else:
            page.row_missing(run.tag, command_of(run))
