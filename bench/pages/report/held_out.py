"""What verdicts rest on: scenes, held-out cameras and pictures, seeds. bench/splits.csv has the
first two.
SPDX-License-Identifier: BSD-2-Clause"""
import csv

from ..words import counted


def held_out(report, scene):
    """(cameras, pictures) that training never saw, no camera where pictures of the training cameras
    at other times are held out; None where the file does not tell."""
    try:
        with open(f"{report.results}/splits.csv", encoding="utf-8") as file:
            for row in csv.DictReader(file):
                if row["scene"] == scene:
                    return int(row["cameras"]), int(row["pictures"])
    except FileNotFoundError:
        pass
    return None


def folders(report, scenes):
    """The folders of scenes of the table: the same folder may be there more than once, each time
    with another camera held out."""
    return {report.runs.where[scene] for scene in scenes}


def cameras(report, scenes):
    """How many held-out cameras scenes have together; None where one of them is not known."""
    found = [held_out(report, scene) for scene in scenes]
    return None if None in found else sum(one[0] for one in found)


def cameras_text(report, scenes):
    number = cameras(report, scenes)
    return "unknown held-out cameras" if number is None else counted(number, "held-out camera")


def rests_on(report, seeds):
    """In words. seeds: how many, by scene."""
    found = [held_out(report, scene) for scene in seeds]
    pictures = "" if None in found else f" ({counted(sum(one[1] for one in found), 'picture')})"
    least, most = min(seeds.values()), max(seeds.values())
    return (f"Rests on {counted(len(folders(report, seeds)), 'scene')}, "
            f"{cameras_text(report, seeds)}{pictures}, "
            f"{'' if least == most else f'{least} to '}{counted(most, 'seed')}")
