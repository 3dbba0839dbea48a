"""Writes a page of bench/ and its charts; prints the runs that a table wants.

    python3 -m bench.pages runs TABLE
    python3 -m bench.pages report|capacity|stability|zoo [STATES]

STATES: a file of lines "STATE TAG", which the script that makes the rows prints with --list; that
script is asked without it. Environment: TED4_RESULTS (bench: where the rows lie and the pages go),
TED4_TABLE (the table of wanted runs), TED4_PAGES (bench: where the report finds raster.md,
render.md, train.md, memory.md and report-notes.md), TED4_NOTES (the notes of stability and zoo).
Run from the project's root. The same rows give the same bytes. Nothing is replaced unless all
succeeds.
SPDX-License-Identifier: BSD-2-Clause"""
import glob
import importlib
import os
import shutil
import subprocess
import sys
import tempfile

from . import wanted
from .rows import Runs
from .svg import Charts

# Of each page: the script and the rows behind it, the folder of its charts, and its module.
PAGES = {
    "report": ("sweep", "charts", "report.page"),
    "capacity": ("capacity", "capacity", "capacity"),
    "stability": ("stability", "lab", "stability"),
    "zoo": ("zoo", "zoo", "zoo"),
}


def read_states(name, table, results, path, scratch):
    """{tag: state} of the wanted runs."""
    if path:
        with open(path, encoding="utf-8") as file:
            text = file.read()
    else:
        text = subprocess.run([f"bench/{name}.sh", "--list"], check=True, text=True,
                              stdout=subprocess.PIPE,
                              env=dict(os.environ, TED4_TABLE=table, TED4_RESULTS=results,
                                       TED4_WORK=scratch)).stdout
    return {word[1]: word[0] for word in map(str.split, text.splitlines())}


def replace_charts(scratch, folder):
    for chart in glob.glob(folder + "/*.svg"):
        os.remove(chart)
    charts = glob.glob(scratch + "/*.svg")
    if charts:
        os.makedirs(folder, exist_ok=True)
    for chart in charts:
        shutil.move(chart, folder)


def write_page(page, states):
    name, folder, module = PAGES[page]
    results = os.environ.get("TED4_RESULTS", "bench")
    table = os.environ.get("TED4_TABLE", f"bench/{name}.txt")
    pages = os.environ.get("TED4_PAGES", "bench")
    module = importlib.import_module("." + module, __package__)
    with tempfile.TemporaryDirectory() as scratch:
        runs = Runs(wanted.read_table(table),
                    read_states(name, table, results, states, scratch + "/work"),
                    f"{results}/{name}.csv")
        os.mkdir(scratch + "/charts")
        texts = module.write(runs, Charts(scratch + "/charts", folder), results, pages)
        replace_charts(scratch + "/charts", f"{results}/{folder}")
    for file_name, text in texts.items():
        with open(f"{results}/{file_name}", "w", encoding="utf-8") as file:
            file.write(text)


def main(arguments):
    if len(arguments) == 2 and arguments[0] == "runs":
        for run in wanted.read_table(arguments[1]):
            print(run.line())
    elif len(arguments) in (1, 2) and arguments[0] in PAGES:
        write_page(arguments[0], arguments[1] if len(arguments) == 2 else None)
    else:
        sys.exit("usage: python3 -m bench.pages runs TABLE | " + "|".join(PAGES) + " [STATES]")


if __name__ == "__main__":
    main(sys.argv[1:])
