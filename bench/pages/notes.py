"""Causes written by hand: bench/{capacity,stability,zoo}-notes.md.
SPDX-License-Identifier: BSD-2-Clause"""


def read_notes(path):
    """{heading: note}, a note in one line. What stands before the first heading "## ..." is for
    readers of the file alone."""
    notes, heading = {}, None
    try:
        with open(path, encoding="utf-8") as file:
            for line in file.read().splitlines():
                if line.startswith("## "):
                    heading = " ".join(line.split()[1:])
                    notes[heading] = []
                elif heading is not None and line:
                    notes[heading].append(line.replace("|", "\\|"))
    except FileNotFoundError:
        pass
    return {heading: " ".join(lines) for heading, lines in notes.items()}
