"""Where the chosen model costs more than a fixed setting: what the rows show, causes by hand
(bench/capacity-notes.md), and attempts.
SPDX-License-Identifier: BSD-2-Clause"""
from .rows import mark
from .words import signed

ATTEMPT = "attempt "    # what the headings of attempts begin with; more: the attempt's name


def over_words(costs, scene):
    """By how much auto costs more than the best fixed setting, and that of each seed."""
    best, autos = costs.best_fixed(scene), costs.runs.present(scene, "auto")
    over = [signed(100 * (costs.of(run) / costs.of(best) - 1), 1) for run in autos]
    text = f"{over[0]} %{mark(autos + [best])} above *{best.variant}*"
    return text if len(over) == 1 else f"{text}; seeds: {', '.join(over)} %"


def section(page, costs, missed, notes):
    """missed: scenes. notes: those of a scene under its name; "search"; attempts."""
    page.heading("Scenes that miss bar 4")
    attempts = [name for name in notes if name.startswith(ATTEMPT)]
    if missed:
        page.prose("""These scenes miss bar 4. For each, the list says by how much auto costs more
            than the best fixed setting, and what the [table](#auto-against-fixed-settings) shows of
            the cause.""")
        page.say()
    else:
        page.prose("No scene of which all rows are of one encoder misses bar 4.")
    for scene in missed:
        page.item(f"{scene} ({over_words(costs, scene)}): "
                  + notes.get(scene, "**not explained yet**"))
    if missed and notes.get("search"):
        page.heading("What the search can change", 3)
        page.prose(notes["search"])
    if missed or attempts:
        page.heading("Attempts", 3)
        show_attempts(page, {name[len(ATTEMPT):]: notes[name] for name in attempts})


def show_attempts(page, attempts):
    if not attempts:
        page.prose("No attempt has been made on this bar.")
        return
    page.say()
    for name, note in attempts.items():
        page.item(f"*{name}*: {note}")
