"""Tables of the stability lab: quality of every scene and variant, anchors thrown out, what the
whole method's runs measured, failures with their causes, strips, commands.
SPDX-License-Identifier: BSD-2-Clause"""
from .rows import mark, own_options
from .stability_rules import RULES
from .words import cells, fixed, percent, signed


def quality_cell(cell):
    """Mean and worst: means over seeds, and the spread between seeds of the mean."""
    if not cell.there:
        return "-"
    n, wanted, spread, marks = len(cell.there), len(cell.wanted), cell.spread(), cell.marks()
    return (f"{fixed(cell.mean('psnr'), 2)} / {fixed(cell.mean('worst'), 2)}"
            + ("" if spread is None else f" ±{spread / 2:.2f}")
            + (f" ({n} of {wanted})" if n < wanted else "") + mark(cell.wanted)
            + (marks and f" **{marks}**"))


def quality_section(lab):
    page = lab.page
    page.heading("Every scene and variant")
    page.prose("""The table shows PSNR in dB on held-out pictures, rendered from the decoded file:
        mean of all / worst of all, both as means over seeds; ± is half the span of the mean over
        seeds. A bold letter marks a failure, and is followed by the number of seeds that fail
        unless all do:""")
    page.say()
    for letter, meaning in RULES.values():
        page.item(f"**{letter}**: {meaning}")
    page.table("scene", *lab.variants)
    for scene in lab.scenes:
        page.row(scene, *map(quality_cell, lab.cells(scene)))
    page.chart(lab.charts, "worst",
               "Worst held-out frame by scene and variant, mean and span over seeds")
    page.chart(lab.charts, "mean", "Mean PSNR by scene and variant, mean and span over seeds")


def out_section(lab):
    page = lab.page
    page.heading("Anchors thrown out of view")
    page.prose("""An anchor is *thrown out* if its own motion, not a camera's, takes it out of view.
        That is the case if, at a time at which something trains it, it is drawn (one of its
        Gaussians reaches the rasteriser's least opacity, 1/255), but its centre (the mean of its
        Gaussians' centres) lies in no picture of that time's training cameras, although one of
        these cameras sees it at another such time. The table shows the share of the drawn anchors
        that are thrown out, and the largest displacement of a drawn anchor, relative to the size of
        the scene (the longest side of the box between the 1st and the 99th percentile of its
        initial points). Both are means over seeds.""")
    page.table("scene", *lab.variants)
    for scene in lab.scenes:
        page.row(scene, *("-" if not cell.there else
                          f"{percent(cell.mean('out_share'), 2)}; "
                          f"{fixed(cell.mean('displacement'), 3)}{mark(cell.wanted)}"
                          for cell in lab.cells(scene)))
    page.chart(lab.charts, "out",
               "Share of drawn anchors thrown out of every picture, by scene and variant")


def term_cell(cell, column):
    """The largest of a number, with the term that a second column names."""
    known = [run for run in cell.wanted if run.text(column)]
    if not known:
        return "-"
    run = max(known, key=lambda one: one.number(column))
    return f"{run.number(column):.3g} ({run.text(column + '_term')})"


def numbers_section(lab):
    page = lab.page
    page.heading("What the whole method's runs measured")
    page.prose("""All numbers are means over seeds, except gradients and rollbacks, which are the
        maximum over them, and *not finite*, which is their sum. *Dead* is the share of Gaussians
        whose opacity is 0 at all times. *Ends* are shares of symbols, steps, contexts, sigma
        indices and activation widths at the ends of their ranges. *Loss* is the distortion in the
        first and in the last line of the log, as running means over about 100 steps. *Clamped*
        counts values of anchors that were at an end of their range when training ended. *Not
        finite* counts pictures and times that the decoder refused, Gaussians that training left
        out, and faulty lines of the log. *Peak* is the largest norm of a gradient as a multiple of
        its term's usual norm.""")
    page.table("scene", "bytes", "anchors", "moving", "dead", "escapes", "ends: symbols", "steps",
               "contexts", "sigma", "widths", "clamped", "not finite", "loss", "largest gradient",
               "peak", "rollbacks", "training s of CPU")
    for scene in lab.scenes:
        cell = lab.cell(scene, "whole")
        if cell.there:
            numbers_row(page, cell)
        else:
            page.row_missing(scene)


def numbers_row(page, cell):
    shares = [percent(cell.mean(name), digits) for name, digits in (
        ("dead", 1), ("escape_share", 3), ("symbol_ends", 3), ("step_ends", 3),
        ("context_ends", 3), ("sigma_ends", 2), ("width_ends", 2))]
    not_finite = cell.sum("refused_views", "refused_times", "log_bad", "skipped")
    page.row(cell.scene + mark(cell.wanted),
             *(fixed(cell.mean(name), 0) for name in ("bytes", "anchors", "dynamic")), *shares,
             fixed(cell.mean("clamped"), 0), f"{not_finite:.0f}",
             f"{fixed(cell.mean('loss_first'), 4)} to {fixed(cell.mean('loss_last'), 4)}",
             term_cell(cell, "gradient"), term_cell(cell, "peak"),
             fixed(cell.most("rollbacks"), 0), fixed(cell.mean("cpu_s"), 1))


def failure_words(cell):
    """What fails, and what ended the runs that have no file."""
    said = []
    for run in cell.wanted:
        why = run.text("why")
        if why and not any(why in other for other in said):
            said.append(why)
    return ("; ".join(f"{meaning} ({n} of {len(cell.there)})" for _, meaning, n in cell.broken())
            + (": " + "; ".join(said) if said else ""))


def rule_items(lab):
    """The notes on rules that some run breaks."""
    all_cells = [cell for scene in lab.scenes for cell in lab.cells(scene)]
    noted = [(letter, lab.notes[f"* {rule}"]) for rule, (letter, _) in RULES.items()
             if f"* {rule}" in lab.notes and any(cell.breaks(rule) for cell in all_cells)]
    if noted:
        lab.page.prose("""Some failures have the same cause in all runs. They are explained here,
            and the table below leaves out runs that fail in no other way:""")
        lab.page.say()
    for letter, note in noted:
        lab.page.item(f"**{letter}**: {note}")


def failure_section(lab):
    """The whole method's failures first, then the variants'. Counts those of the whole method."""
    page = lab.page
    page.heading("Failures and their causes")
    page.prose("""Causes and remedies are written by hand in
        [stability-notes.md](stability-notes.md).""")
    rule_items(lab)
    page.table("scene", "variant", "what fails", "cause and remedy")
    for variant in lab.variants:
        for scene in lab.scenes:
            cell = lab.cell(scene, variant)
            if not cell.marks():
                continue
            own, by_rule, is_whole = lab.note(scene, variant), lab.by_rule(cell), variant == "whole"
            lab.failures += is_whole
            lab.unexplained += is_whole and not (own or by_rule)
            if own or not by_rule:
                page.row(scene, variant, failure_words(cell),
                         own or ("**unexplained**" if is_whole else "-"))
    for scene in lab.scenes:
        for i, variant in enumerate(lab.variants):
            if f"{scene} {variant}" in lab.unread or (i == 0 and f"{scene} *" in lab.unread):
                page.prose(f"No longer a failure, on {scene}: {lab.note(scene, variant)}")


def seeds_section(lab, most):
    """The seeds of easy scenes, with a note on those farther apart than the bar's most, dB."""
    easy = [lab.cell(scene, "whole") for scene in lab.in_group("easy")]
    if not any(cell.there for cell in easy):
        return
    page = lab.page
    page.heading("Seeds of easy scenes")
    page.prose("""These are the runs of bar 3, with the worst held-out picture and its camera.
        *Loss* is that of the last line of the log, as above.""")
    page.table("scene", "seed", "PSNR", "worst (camera)", "bytes", "anchors", "moving", "Gaussians",
               "loss")
    for cell in easy:
        for run in cell.there:
            page.row(run.scene + mark([run]), run.place, fixed(run.number("psnr"), 2),
                     f"{fixed(run.number('worst'), 2)} ({run.text('worst_camera')})",
                     *cells(run, "bytes anchors dynamic gaussians loss_last:4"))
    apart = [cell for cell in easy if (cell.spread() or 0) >= most]
    if apart:
        page.say()
    for cell in apart:
        page.item(f"{cell.scene}, {cell.spread():.2f} dB apart: "
                  + lab.notes.get(f"{cell.scene} seeds", "**not explained yet**"))


def strip_section(lab):
    page = lab.page
    page.heading("Worst frames")
    page.prose("""Each strip shows ground truth, rendering and error (5 times) of the worst held-out
        picture of the whole method's first seed.""")
    page.table("scene", "worst dB", "frame", "camera", "strip")
    for run in lab.runs.all:
        if not run.keeps("strip"):
            continue
        if run.text("worst"):
            page.row(run.name(), *cells(run, "worst:2 worst_frame worst_camera"),
                     f"![{run.scene}](lab/{run.tag}.jpg)")
        else:
            page.row_missing(run.tag)


def command_section(lab):
    page, runs = lab.page, lab.runs
    page.heading("Commands")
    page.prose("""`make stability` runs what is missing and writes this page; `bench/stability.sh
        PATTERN...` runs a part of it, `bench/stability.sh --only TAG` one run (for a cluster's job
        array), and `python3 -m bench.pages stability` writes the page. Scenes
        `own:NAME+size=96x64` are made by `ted4scene NAME --size 96x64 -o FOLDER`. † marks results
        of older sources or other options. [stability.csv](stability.csv) has all columns.""")
    if runs.strangers:
        page.prose(f"It holds {runs.strangers} rows that stability.txt does not list; they are not "
                   "shown.")
    page.table("run", "command", "key")
    for run in runs.all:
        if run.place == "1" and run.variant == "whole":
            options = run.text("options") if run.has() else run.options
            page.row(run.name(), f"`ted4enc {run.where} {options}`",
                     run.text("key") if run.has() else "not run yet")
    page.prose("Other seeds and variants differ by:")
    page.table("variant", "options")
    for variant in lab.variants:
        options = own_options(runs, runs.first(lab.scenes[0], variant), ("set",))
        page.row(variant, options and f"`{options}`")
