"""bench/stability.md: where the method and its variants fail. Judges bars 1 to 3 of the lab.
SPDX-License-Identifier: BSD-2-Clause"""
import os

from . import stability_beside as beside
from . import stability_tables as tables
from .bars import DELIVERED, Bars, First
from .compare import is_mixed, of_one_encoder
from .earlier import earlier
from .notes import read_notes
from .stability_marks import draw
from .stability_rules import RULES, Cell
from .words import Page, signed

MOST_SEED_SPREAD = 0.3  # dB, on easy scenes
LEAST_GAIN = 1          # dB of the worst frame, where things come, go or hide
SCENES, VARIANTS = 16, 6


class Lab:
    """scenes, variants: those of the lab, in the order of the table."""

    def __init__(self, runs, charts, notes, results):
        self.runs, self.charts, self.notes, self.results = runs, charts, notes, results
        self.unread = dict(notes)
        self.scenes = [scene for scene in runs.scenes if runs.wants(scene, "whole", "lab")]
        self.variants = [variant for variant in runs.variants
                         if any(runs.wants(scene, variant, "lab") for scene in self.scenes)]
        self.page, self.bars = Page(), Bars()
        self.failures = self.unexplained = 0

    def cell(self, scene, variant):
        return Cell(self, scene, variant)

    def cells(self, scene):
        return [self.cell(scene, variant) for variant in self.variants]

    def in_group(self, group):
        """Scenes whose whole method belongs to a group."""
        return [scene for scene in self.scenes if self.runs.wants(scene, "whole", group)]

    def note(self, scene, variant):
        """"" when there is none."""
        key = f"{scene} {variant}"
        key = key if key in self.notes else f"{scene} *"
        self.unread.pop(key, None)
        return self.notes.get(key, "")

    def by_rule(self, cell):
        """Whether each rule that a cell breaks has a note of its own."""
        return all(f"* {rule}" in self.notes for rule in RULES if cell.breaks(rule))


def write(runs, charts, results, _):
    """{name of the file: text}, with charts drawn."""
    lab = Lab(runs, charts, read_notes(os.environ.get("TED4_NOTES", "bench/stability-notes.md")),
              results)
    draw(lab, "worst", "Worst held-out frame", "PSNR dB", "worst")
    draw(lab, "mean", "Mean of held-out frames", "PSNR dB", "psnr")
    draw(lab, "out", "Anchors thrown out of every picture", "% of drawn anchors", "out_share",
         factor=100, zero=True)
    tables.quality_section(lab)
    tables.failure_section(lab)
    tables.out_section(lab)
    beside.points_section(lab)
    beside.parts_section(lab)
    beside.colours_section(lab)
    tables.numbers_section(lab)
    tables.seeds_section(lab, MOST_SEED_SPREAD)
    tables.strip_section(lab)
    tables.command_section(lab)
    run_bars(lab)
    come_bars(lab)
    seed_bars(lab)
    head = Page()
    head.heading("The stability lab", 1)
    head.prose("""The lab trains the whole method and its variants on small, hard scenes, with
        several seeds, and shows what fails and why. `make stability` writes this page from
        [stability.csv](stability.csv); "not run yet" stands wherever a run is missing.""")
    head.prose(runs.summary() + ".")
    head.prose(lab.bars.summary())
    lab.bars.show(head, "command, then `python3 -m bench.pages stability`")
    head.say()
    return {"stability.md": head.text() + lab.page.text()}


def command(patterns=""):
    return f"`bench/stability.sh {patterns}`" if patterns else "`bench/stability.sh`"


def has_three(cell):
    return len(cell.there) >= 3


def run_bars(lab):
    """1: enough of it ran; the whole method does not break; what is weak is explained."""
    all_cells = [lab.cells(scene) for scene in lab.scenes]
    complete = sum(all(map(has_three, cells)) for cells in all_cells)
    rows = sum(len(cell.there) for cells in all_cells for cell in cells)
    wanted = sum(len(cell.wanted) for cells in all_cells for cell in cells)
    enough = complete >= SCENES
    lab.bars.add(1, "what ran", "at least 16 scenes x 3 seeds x 6 variants",
                 f"{complete} scenes whole, with {len(lab.variants)} variants; {rows} of {wanted} "
                 "rows", DELIVERED if enough and len(lab.variants) >= VARIANTS else None, command())
    whole = [lab.cell(scene, "whole") for scene in lab.scenes]
    broken = sum(cell.breaks(rule) for cell in whole
                 for rule in ("crash", "error", "nan", "diverges"))
    lab.bars.add(1, "whole method: crash, error, NaN, divergence", "none",
                 f"{broken} in {sum(len(cell.there) for cell in whole)} runs",
                 False if broken else True if enough else None, command("'*-whole-*'"))
    lab.bars.add(1, "weak spots of the whole method", "every one explained",
                 f"{lab.failures} scenes, {lab.unexplained} of them unexplained",
                 False if lab.unexplained else DELIVERED if enough else None,
                 "[notes](stability-notes.md)")


def come_bars(lab):
    """2: where things come, go or hide."""
    for scene in lab.in_group("come"):
        whole, without = lab.cell(scene, "whole"), lab.cell(scene, "noactive")
        gain = None
        if whole.mean("worst") is not None and without.mean("worst") is not None:
            gain = whole.mean("worst") - without.mean("worst")
        complete = has_three(whole) and has_three(without)
        ok, measured = of_one_encoder(
            gain >= LEAST_GAIN if complete and gain is not None else None,
            signed(gain, 2, " dB"), whole.wanted + without.wanted)
        lab.bars.add(2, f"{scene}: worst frame, whole method above no activation", "at least 1 dB",
                     measured, ok,
                     command(f"'{scene}-whole-*' '{scene}-noactive-*'"))
    thrown_bar(lab)


def thrown_bar(lab):
    """2: anchors that leave every picture, in these scenes together; where none does either way
    there is nothing to be fewer than."""
    pairs = [(lab.cell(scene, "whole"), lab.cell(scene, "noactive"))
             for scene in lab.in_group("come")]
    complete = all(has_three(a) and has_three(b) for a, b in pairs)
    out = {a.scene: (a.mean("out") or 0, b.mean("out") or 0) for a, b in pairs
           if a.there and b.there}
    ok = None
    if complete and out:
        with_it, without = (sum(both[i] for both in out.values()) for i in (0, 1))
        more = any(a > b for a, b in out.values())
        ok = "?" if with_it + without == 0 else with_it < without and not more
    ok, measured = of_one_encoder(
        ok, ", ".join(f"{scene} {a:.1f} against {b:.1f}" for scene, (a, b) in out.items()),
        [run for pair in pairs for cell in pair for run in cell.wanted])
    lab.bars.add(2, "anchors thrown out of view where objects come, go or hide, means over seeds",
                 "fewer than without activation, and in no scene more", measured, ok,
                 command("'*-whole-*' '*-noactive-*'"), first_thrown(lab))


def first_thrown(lab):
    """The bar of thrown_bar as it first was; None as long as a scene of it is missing."""
    verdicts = {}
    for scene in lab.in_group("come_first"):
        cells = [lab.cell(scene, variant) for variant in ("whole", "noactive")]
        if not all(map(has_three, cells)):
            return None
        ours, theirs = (cell.mean("out") or 0 for cell in cells)
        mixed = is_mixed(run for cell in cells for run in cell.there)
        verdicts[scene] = "?" if mixed or ours + theirs == 0 else ours < theirs
    found = list(verdicts.values())
    if not found:
        return None
    return First("in each of " + ", ".join(verdicts) + " by itself, fewer than without activation"
                 " (the other scenes were made later)",
                 "; ".join(f"{scene}: {Bars.WORDS[ok]}" for scene, ok in verdicts.items()),
                 False if False in found else "?" if "?" in found else True)


def spread_text(spreads):
    return "; ".join(f"{scene} {spread:.2f} dB" for scene, spread in spreads.items())


def first_easy(lab):
    """The bar of the spread as it first was: of other easy scenes, and turn with six cameras, whose
    rows are gone. None as long as none of them has rows."""
    cells = [lab.cell(scene, "whole") for scene in lab.in_group("easy_first")]
    spreads = {cell.scene: cell.spread() for cell in cells if cell.spread() is not None}
    if not spreads:
        return None
    gone, was_met = earlier(lab.results, "easy_six_cameras")
    missed = any(spread >= MOST_SEED_SPREAD for spread in spreads.values()) or was_met is False
    return First("easy scenes: turn with six cameras, " + ", ".join(spreads),
                 "; ".join(filter(None, (spread_text(spreads), gone))), not missed)


def seed_bars(lab):
    """3: seeds."""
    easy = [lab.cell(scene, "whole") for scene in lab.in_group("easy")]
    spreads = {cell.scene: cell.spread() for cell in easy if cell.spread() is not None}
    worst = max(spreads.values(), default=None)
    ok, measured = of_one_encoder(
        None if worst is None else False if worst >= MOST_SEED_SPREAD
        else True if all(map(has_three, easy)) else None,
        spread_text(spreads), [run for cell in easy for run in cell.wanted])
    lab.bars.add(3, "spread of mean PSNR between seeds, easy scenes", "below 0.3 dB", measured, ok,
                 command("easy"), first_easy(lab))
    again = [(lab.runs.first(scene, "again"), lab.runs.first(scene, "whole"))
             for scene in lab.scenes if lab.runs.of(scene, "again")]
    compared = [(a, b) for a, b in again
                if all(run.has() and not run.is_old() and run.text("status") == "fine"
                       for run in (a, b))]
    same = sum(a.text("hash") == b.text("hash") and a.text("bytes") == b.text("bytes")
               for a, b in compared)
    lab.bars.add(3, "the same seed trained twice", "the same bytes",
                 f"{len(compared)} of {len(again)} scenes compared, {same} equal in size and hash",
                 False if len(compared) > same else True if again and len(compared) == len(again)
                 else None, command("again '*-whole-1'"))
