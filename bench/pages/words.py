"""A page as it grows: prose and tables.
SPDX-License-Identifier: BSD-2-Clause"""
import re
import textwrap

WIDTH = 100


def fixed(number, digits):
    return "-" if number is None else f"{number:.{digits}f}"


def signed(number, digits, unit=""):
    return "-" if number is None else f"{number:+.{digits}f}{unit}"


def percent(share, digits):
    return "-" if share is None else f"{100 * share:.{digits}f} %"


def counted(number, word):
    return f"{number} {word}{'' if number == 1 else 's'}"


def cells(run, names):
    """Columns of a run's row as cells. names: divided by spaces, with ":DIGITS" where a number is
    rounded; team: jobs and threads."""
    found = []
    for name in names.split():
        column, _, digits = name.partition(":")
        if column == "team":
            found.append(f"{run.text('jobs')} x {run.text('threads')}")
        elif digits:
            found.append(fixed(run.number(column), int(digits)))
        else:
            found.append(run.text(column))
    return found


def fill(text, first="", rest=""):
    """Prose in lines of at most WIDTH columns; a number keeps its unit."""
    text = re.sub(r"([0-9]) (dB|kB|MB|ms|%|±)", "\\1\u00a0\\2", " ".join(text.split()))
    text = textwrap.fill(text, WIDTH, initial_indent=first, subsequent_indent=rest,
                         break_long_words=False, break_on_hyphens=False)
    return text.replace("\u00a0", " ")


def anchor(heading):
    """What a heading is called in a link."""
    return re.sub(r"[^a-z0-9_-]", "", heading.lower().replace(" ", "-"))


class Page:
    def __init__(self):
        self.lines, self.columns = [], 0

    def say(self, line=""):
        self.lines.append(line)

    def heading(self, text, depth=2):
        if self.lines:
            self.say()
        self.say("#" * depth + " " + text)

    def prose(self, text):
        """A paragraph."""
        self.say()
        self.say(fill(text))

    def item(self, text, point="* "):
        """A point of a list."""
        self.say(fill(text, point, " " * len(point)))

    def table(self, *titles):
        self.columns = len(titles)
        self.say()
        self.say("| " + " | ".join(titles) + " |")
        self.say("|---" * len(titles) + "|")

    def row(self, *texts):
        """A row whose first cells are given, and whose others are empty."""
        texts = list(texts) + [""] * (self.columns - len(texts))
        self.say(re.sub("  +", " ", "| " + " | ".join(texts) + " |"))

    def row_missing(self, *texts):
        self.row(*texts, "not run yet")

    def chart(self, charts, name, text):
        """The picture of a chart that was drawn, or what is said in its place."""
        self.say()
        self.say(f"![{text}]({charts.place}/{name}.svg)" if name in charts.drawn
                 else fill(f"*{text}*: not run yet."))

    def text(self):
        return "\n".join(self.lines) + "\n"
