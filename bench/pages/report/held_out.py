"""What a verdict rests on: scenes, held-out cameras and pictures, seeds. bench/held-out.csv tells
the cameras.
SPDX-License-Identifier: BSD-2-Clause"""
import csv


def held_out(report, scene):
    """(cameras, pictures) that training never saw; None where the file does not tell."""
    try:
        with open(f"{report.results}/held-out.csv", encoding="utf-8") as file:
            for row in csv.DictReader(file):
                if row["scene"] == scene:
                    return int(row["cameras"]), int(row["pictures"])
    except FileNotFoundError:
        pass
    return None


def counted(number, word):
    return f"{number} {word}{'' if number == 1 else 's'}"


def rests_on(report, scene, seeds):
    """The same in words, to be added to what was measured."""
    found = held_out(report, scene)
    cameras = (f"{counted(found[0], 'held-out camera')} ({counted(found[1], 'picture')})" if found
               else "unknown held-out cameras")
    return f"; rests on 1 scene, {cameras}, {counted(seeds, 'seed')}"
