"""A bar about a part of the method, judged on every scene that has the rows: one verdict.
SPDX-License-Identifier: BSD-2-Clause"""
from collections import namedtuple

from .held_out import cameras, cameras_text, folders, rests_on

# The part on one scene. options: those that change it; measured: text; ok: as Bars.add takes it;
# more: what else belongs to that verdict; seeds: how many.
Judged = namedtuple("Judged", "scene options measured ok more seeds")


def verdict(report, judged):
    """(ok, what belongs to it): missed where one scene misses it; met where all scenes meet it,
    and where these are at least two, with more than one held-out camera together."""
    scenes = [one.scene for one in judged]
    ok = combined([one.ok for one in judged])
    reasons = []
    if ok is not True:
        reasons.append("on " + ", ".join(one.scene for one in judged if one.ok == ok))
    if len(folders(report, scenes)) < 2:
        reasons.append("one scene alone")
    elif (cameras(report, scenes) or 0) < 2:
        reasons.append("rests on " + cameras_text(report, scenes))
    return "?" if ok is True and reasons else ok, "; ".join(reasons)


def combined(verdicts):
    if False in verdicts:
        return False
    return "?" if "?" in verdicts else True


def measured_text(report, judged):
    words, same = report.bars.WORDS, len({one.options for one in judged}) == 1
    text = f"`{judged[0].options}`; " if same else ""
    for one in judged:
        text += (f"{one.scene}{'' if same else f', `{one.options}`'}: {one.measured}: "
                 f"{words[one.ok]}{one.more and f' ({one.more})'}. ")
    return text + rests_on(report, {one.scene: one.seeds for one in judged})


def add_bar(report, what, limit, judged, missing, how, first=None):
    """judged: of the scenes that have the rows. missing: the other scenes of the table."""
    measured, ok, more = "", None, ""
    if judged:
        ok, more = verdict(report, judged)
        measured = measured_text(report, judged)
        if missing:
            measured += ". Not run yet: " + ", ".join(missing)
        report.grounds.append([one.scene for one in judged])
    report.bars.add(1, what, limit, measured, ok, how, first, more)
