"""What a page promises, and whether it was met: verdicts, and definitions that changed.
SPDX-License-Identifier: BSD-2-Clause"""
from collections import namedtuple

DELIVERED = "delivered"

# A bar as it was first defined, where that definition was given up after a run had missed it or had
# left it open. definition, measured: texts; ok: as Bars.add takes it.
First = namedtuple("First", "definition measured ok")
# A row of the table; said: the verdict with what belongs to it.
Row = namedtuple("Row", "number what limit measured said how verdict")


class Bars:
    """ok: True, False, None (not run yet), "?" (measured, but it says neither), or DELIVERED (it is
    there; no measurement could have missed it)."""

    WORDS = {True: "met", False: "**missed**", None: "not run yet", "?": "undecided",
             DELIVERED: "delivered"}

    def __init__(self):
        self.rows, self.verdicts = [], dict.fromkeys(self.WORDS.values(), 0)
        self.changed = []

    def add(self, number, what, limit, measured, ok, how, first=None, more=""):
        """first: a First. more: what else belongs to the verdict."""
        verdict = said = self.WORDS[ok]
        self.verdicts[verdict] += 1
        if more:
            said += f": {more}"
        if first is not None and ok is not None:
            self.changed.append((str(number), what, verdict, first))
            said += f"; as first defined: {self.WORDS[first.ok]}"
        self.rows.append(Row(str(number), what, limit, measured or "-", said, how, verdict))

    def show(self, page, how):
        page.table("#", "what", "bar", "measured", "verdict", how)
        for row in self.rows:
            page.row(*row[:-1])
        self.show_changed(page)

    def show_changed(self, page):
        if not self.changed:
            return
        page.heading("Definitions that changed", 3)
        page.prose("""The definitions of these bars were changed, or the bars were added, after a
            run had missed the first definition or had left it open. The table judges the same rows
            by the first definition; where these rows cannot tell, it says so.""")
        page.table("#", "bar as it is now", "verdict now", "first definition", "measured by it",
                   "verdict by it")
        for number, what, verdict, first in self.changed:
            page.row(number, what, verdict, first.definition, first.measured or "-",
                     self.WORDS[first.ok])

    def summary(self, page=""):
        """How many there are of each verdict, in sentences. page: the file that shows the bars,
        where that is another one."""
        count = self.verdicts
        text = (f"Bars: {count['met']} met, {count['**missed**']} missed, "
                f"{count['not run yet']} not run yet"
                + "".join(f", {count[word]} {word}" for word in ("undecided", "delivered")
                          if count[word]) + ".")
        if count["delivered"]:
            text += (" *Delivered* is what is there by construction (a chart, a note, a budget that"
                     " the program keeps): no measurement could have missed it.")
        return text + self.summary_of_changed(page)

    def summary_of_changed(self, page):
        """Of those met, how many are not by their first definition."""
        met = [first.ok for _, _, verdict, first in self.changed if verdict == "met"]
        other = [f"{met.count(ok)} {word}" for ok, word in (
            (False, "would be missed"), ("?", "would be undecided"), (None, "could not be judged"))
                 if ok in met]
        if not other:
            return ""
        return (f" Of the {self.verdicts['met']} met, {' and '.join(other)} by the [first "
                f"definition]({page}#definitions-that-changed).")
