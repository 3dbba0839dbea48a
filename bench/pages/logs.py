"""Logs of trainings: the JSON lines that `ted4enc --log FILE` writes.
SPDX-License-Identifier: BSD-2-Clause"""
import json


def read_lines(path):
    """Whole lines of a log as dictionaries; none without the file. A kill may leave half a line."""
    lines = []
    try:
        with open(path, encoding="utf-8") as file:
            for text in file:
                if text.startswith("{") and text.rstrip("\n").endswith("}"):
                    lines.append(json.loads(text))
    except FileNotFoundError:
        pass
    return lines
