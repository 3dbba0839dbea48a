"""What all sections of the report share.
SPDX-License-Identifier: BSD-2-Clause"""
from ..bars import Bars
from ..plot import SceneStyles
from ..seeded import Family
from ..words import Page


class Report:
    """runs: wanted runs and rows. results: folder of sweep.csv, logs and pictures. pages: folder
    of raster.md and the other pages that it takes numbers from. tables: the page of all tables.
    family: all comparisons over seeds. grounds: of each bar about a part of the method that has
    rows, the scenes."""

    def __init__(self, runs, charts, results, pages):
        self.runs, self.charts, self.results, self.pages = runs, charts, results, pages
        self.tables, self.bars, self.grounds = Page(), Bars(), []
        self.scenes, self.family = runs.curve_scenes(), Family(runs)
        self.styles = SceneStyles(self.scenes)


def sweep(patterns=""):
    """How the rows that match shell patterns are made."""
    return f"`bench/sweep.sh {patterns}`" if patterns else "`bench/sweep.sh`"
