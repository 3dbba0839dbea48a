"""bench/zoo.md: scenes as other people write them, each against a reference scene.
SPDX-License-Identifier: BSD-2-Clause"""
import os
import re

from .bars import Bars
from .notes import read_notes
from .rows import made_with, mark
from .words import Page, cells, fixed, percent, signed

MOST_BELOW = 1      # dB below the reference scene
LEAST_MOVING = 22   # dB inside the masks of what moves, where cameras take turns
LEAST_CASES = 24
# What is predicted: parts of the time, decibels, parts of the bytes.
MOST_TIME, MOST_PSNR, MOST_BYTES = 0.25, 0.5, 0.05


class Case:
    """A scene of the table: its run, and that of its reference scene (None without)."""

    def __init__(self, runs, scene, references):
        self.scene, self.reference = scene, references.get(scene, "")
        self.run = runs.first(scene, runs.variants[0])
        self.reference_run = (runs.first(self.reference, runs.variants[0]) if self.reference
                              else None)

    def is_fine(self):
        return self.run.text("status") == "fine"

    def takes_turns(self):
        return "+turns" in re.findall(r"\+[^+=]*", self.run.where)

    def is_shown(self):
        """Whether what moves is shown where cameras take turns; None where they do not, or the row
        does not tell."""
        moving = self.run.number("moving_psnr")
        return moving >= LEAST_MOVING if self.takes_turns() and moving is not None else None

    def above(self):
        """Decibels above the reference scene; None where one of the two is not known."""
        both = (self.run, self.reference_run)
        if self.reference_run is None or not all(run.text("status") == "fine" and run.text("psnr")
                                            for run in both):
            return None
        return self.run.number("psnr") - self.reference_run.number("psnr")

    def is_below(self):
        return self.above() is not None and self.above() < -MOST_BELOW

    def missed(self):
        """What is missed; "" when all is met."""
        if not self.is_fine():
            return " ".join((self.run.text("status"), self.run.text("exit") + ":",
                             self.run.text("why")))
        why = (["below its reference"] if self.is_below() else [])
        return ", ".join(why + (["what moves"] if self.is_shown() is False else []))

    def commands(self):
        """Of ted4scene, and the options of ted4enc that not all runs have alike."""
        text = re.sub("^own:", "ted4scene ", self.run.where)
        text = "`" + text.replace("+", " --").replace("=", " ") + "`"
        options = re.sub(r"--(seed|preset) [^ ]+ ?", "", self.run.options).rstrip(" ")
        return text + (options and f", `{options}`")


class Predicted:
    """How far off the log's last lines were, at most; None where the row does not tell. The run has
    the machine for itself."""

    def __init__(self, run):
        low, high, psnr, size = (run.number(name) for name in (
            "estimate_low", "estimate_high", "last_psnr", "last_bytes"))
        self.time = None if low is None or high is None else max(1 - low, high - 1)
        self.psnr = None if psnr is None else abs(psnr - run.count("psnr"))
        self.bytes = None if size is None else abs(size / run.count("bytes") - 1)


def read_references(table):
    """{case: its reference scene, "" without}, from the lines "case NAME REFERENCE WHERE ..." of
    the table."""
    with open(table, encoding="utf-8") as file:
        lines = [line.split() for line in file]
    return {word[1]: "" if word[2] == "-" else word[2] for word in lines
            if len(word) >= 4 and word[0] == "case"}


class Zoo:
    def __init__(self, runs, table, notes):
        self.runs, self.notes = runs, notes
        references = read_references(table)
        self.cases = [Case(runs, scene, references) for scene in runs.scenes
                      if scene in references]
        self.there = [case for case in self.cases if case.run.has()]
        self.alone = self.of("alone")
        self.long = self.of("medium")
        self.lab = self.of("lab")
        self.predicted = {run.tag: Predicted(run) for run in self.alone
                          if run.text("status") == "fine"}

    def of(self, variant):
        return [self.runs.first(scene, variant) for scene in self.runs.scenes
                if self.runs.of(scene, variant)]

    def so_far(self, bad):
        """Whether all is met; None while rows are missing and nothing is missed yet."""
        return False if bad else None if len(self.there) < len(self.cases) else True


def write(runs, _charts, _results, _pages):
    """{name of the file: text}."""
    zoo = Zoo(runs, os.environ.get("TED4_TABLE", "bench/zoo.txt"),
              read_notes(os.environ.get("TED4_NOTES", "bench/zoo-notes.md")))
    page = Page()
    page.heading("The zoo: scenes as other people write them", 1)
    sources = made_with([case.run for case in zoo.cases])
    page.prose(f"""The zoo tests scenes that are written as other people write them. Each case has
        the content of a reference scene, and should come out as well. Reference scenes have nothing
        unusual: several cameras at each time, points on surfaces, opaque PNG. `make zoo` writes
        this page from [zoo.csv](zoo.csv): {len(zoo.there)} of {len(zoo.cases)} wanted runs are
        there{sources}. The cases are listed in [zoo.txt](zoo.txt). The command makes the scene;
        then `ted4enc SCENE -o FILE.ted4 --preset draft --seed 1` trains it, with the options that
        stand behind the command. The preset is draft, because the default takes several times as
        long. Rows of older sources (†) were made in profile Main, when the presets were longer:
        14,000 steps in `draft`, 60,000 in `medium`.""")
    bars = Bars()
    case_bars(zoo, bars)
    back_bar(bars, zoo.lab, "the same on the scenes of the stability lab",
             "`bench/zoo.sh lab`")
    back_bar(bars, zoo.long, "the same in long trainings", "`bench/zoo.sh long`")
    predicted_bars(zoo, bars)
    page.prose(bars.summary())
    bars.show(page, "command; then `python3 -m bench.pages zoo`")
    show_cases(zoo, page)
    show_back(page, zoo.long, "Long trainings", "These are trainings with preset `medium`.")
    show_back(page, zoo.lab, "The stability lab", """These are the scenes of
        [stability.md](stability.md), at one seed and with its options. They test the divergence
        monitor alone.""")
    show_alone(zoo, page)
    show_misses(zoo, page)
    return {"zoo.md": page.text()}


def case_bars(zoo, bars):
    there, marks = zoo.there, mark([case.run for case in zoo.there])
    fine = sum(case.is_fine() for case in there)
    bars.add(1, "cases that end with exit status 0", "all of at least 24",
             f"{fine} of {len(there)}{marks}",
             False if len(zoo.cases) < LEAST_CASES else zoo.so_far(len(there) - fine),
             "`bench/zoo.sh`")
    held = sum(case.above() is not None for case in there)
    below = sum(case.is_below() for case in there)
    bars.add(1, "held-out pictures against the reference scene", f"at most {MOST_BELOW} dB below",
             f"{held - below} of {held}{marks}", zoo.so_far(below), "`bench/zoo.sh`")
    turns = [case for case in there if case.takes_turns()]
    shown = [case.is_shown() for case in turns]
    ok = zoo.so_far(False in shown)
    bars.add(2, "cameras that take turns: moving objects in training pictures",
             f"at least {LEAST_MOVING} dB",
             f"{shown.count(True)} of {len(turns)}{mark([case.run for case in turns])}",
             "?" if ok and None in shown else ok, "`bench/zoo.sh 'turns*'`")
    back = sum(case.run.count("rollbacks") for case in there)
    bars.add(3, "the divergence monitor rolls training back", "never", f"{back:.0f} times{marks}",
             zoo.so_far(back), "`bench/zoo.sh`")


def back_bar(bars, runs, what, how):
    there = [run for run in runs if run.has()]
    back = sum(run.count("rollbacks") + (run.text("status") != "fine") for run in there)
    bars.add(3, what + ", or a training fails", "never",
             f"{len(there)} trainings, {back:.0f} times{mark(there)}",
             False if back else None if len(there) < len(runs) else True, how)


def predicted_bars(zoo, bars):
    how = "`bench/zoo.sh --jobs 1 --threads 0 alone`"
    there = [run for run in zoo.alone if run.has()]

    def add(what, limit, measure, most, text):
        known = [value for value in map(measure, zoo.predicted.values()) if value is not None]
        ok = None if len(there) < len(zoo.alone) else "?" if len(known) < len(there) else True
        bars.add(4, what, limit,
                 f"at worst {text(max(known))}, {len(known)} runs{mark(there)}" if known else "",
                 False if known and max(known) > most else ok, how)

    add("predicted training time, from a tenth of it on; alone on the machine", "within 25 %",
        lambda one: one.time, MOST_TIME, lambda worst: percent(worst, 1))
    add("`psnr` of the last line against the file", "within 0.5 dB", lambda one: one.psnr,
        MOST_PSNR, decibels)
    add("`bytes` of the last line against the file", "within 5 %", lambda one: one.bytes,
        MOST_BYTES, lambda worst: percent(worst, 2))


def decibels(number):
    return "-" if number is None else f"{number:.2f} dB"


def show_cases(zoo, page):
    page.heading("Every case")
    page.prose("""PSNR is in dB: of held-out pictures, its difference from the reference scene's, of
        training pictures, and of *moving objects* in these, over all pixels inside the masks of the
        objects and their shadows. Seconds are of one core; warnings are those of ted4enc;
        *rollbacks* are those of the divergence monitor.""")
    page.table("case", "command", "reference", "held out", "against reference", "training",
               "moving objects", "bytes", "anchors", "steps", "seconds", "warnings", "rollbacks",
               "verdict")
    for case in zoo.cases:
        if not case.run.has():
            page.row_missing(case.scene, case.commands(), case.reference)
            continue
        run, why = case.run, case.missed()
        page.row(case.scene + mark([run]), case.commands(), case.reference or "-",
                 fixed(run.number("psnr"), 2), signed(case.above(), 2),
                 *cells(run, "train_psnr:2 moving_psnr:2 bytes anchors steps cpu_s:0 warnings "
                             "rollbacks"), f"**{why}**" if why else "met")


def show_back(page, runs, title, text):
    if not runs:
        return
    page.heading(title)
    page.prose(text)
    page.table("case", "held out", "training", "moving objects", "bytes", "steps", "seconds",
               "rollbacks")
    for run in runs:
        if run.has():
            page.row(run.scene + mark([run]), *cells(
                run, "psnr:2 train_psnr:2 moving_psnr:2 bytes steps cpu_s:0 rollbacks"))
        else:
            page.row_missing(run.scene)


def show_alone(zoo, page):
    if not zoo.alone:
        return
    page.heading("Predicted time, PSNR and bytes")
    page.prose("""The table shows the largest error of the training time that `ted4enc` predicts,
        from a tenth of the training on, and the differences between `psnr` and `bytes` of its last
        line and those of the file. Each run has the machine to itself.""")
    page.table("case", "seconds", "time", "psnr", "bytes")
    for run in zoo.alone:
        if not run.has():
            page.row_missing(run.scene)
            continue
        one = zoo.predicted.get(run.tag)
        page.row(run.scene + mark([run]), fixed(run.number("train_s"), 0), *(
            (percent(one.time, 1), decibels(one.psnr), percent(one.bytes, 2)) if one else "---"))


def show_misses(zoo, page):
    page.heading("Cases that miss a bar")
    missed = [case for case in zoo.there if case.missed()]
    if not missed:
        page.prose("None." if zoo.there else "Not run yet.")
        return
    page.say()
    for case in missed:
        page.item(f"{case.scene} ({case.missed()}): "
                  + zoo.notes.get(case.scene, "**not explained yet**"))
