"""Writes a page of bench/ and its charts; answers what the scripts that make the rows ask.

    python3 -m bench.pages report|capacity|stability|zoo|bd_rate [STATES]
    python3 -m bench.pages runs TABLE          the runs that a table wants, a line each:
        GROUPS|TAG|SCENE|WHERE|VARIANT|PLACE|LAMBDA|KEEP|STAGE1|OPTIONS
    python3 -m bench.pages times LOG...        training_times of logs.py, divided by commas
    python3 -m bench.pages thin MOST LOG...    thinned
    python3 -m bench.pages predicted SECONDS LOG
    python3 -m bench.pages budget FILE         bytes by syntax element, divided by commas

STATES: a file of lines "STATE TAG", which the script that makes the rows prints with --list; that
script is asked without it. Environment: TED4_RESULTS (bench: where the rows lie and the pages go),
TED4_TABLE (the table of wanted runs), TED4_PAGES (bench: where the report finds raster.md,
render.md, train.md, memory.md and report-notes.md), TED4_NOTES (the notes of capacity, stability
or zoo). Run from the project's root. The same rows give the same bytes. Nothing is replaced before
all is written; then each file is replaced whole. A kill between these renames leaves some old.
SPDX-License-Identifier: BSD-2-Clause"""
import glob
import importlib
import os
import subprocess
import sys
import tempfile

from . import budget, logs, wanted
from .rows import Measured, Runs
from .svg import Charts

# Of each page: the script and the rows behind it, the folder of its charts, and its module.
PAGES = {
    "report": ("sweep", "charts", "report.page"),
    "capacity": ("capacity", "capacity", "capacity"),
    "stability": ("stability", "lab", "stability"),
    "zoo": ("zoo", "zoo", "zoo"),
    "bd_rate": ("bd_rate", "bd_rate", "bd_rate"),
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


def replace_all(texts, old):
    """texts: {path: text} that take the place of what is there, together; of the old paths those go
    that are not among them."""
    try:
        for path, text in texts.items():
            os.makedirs(os.path.dirname(path), exist_ok=True)
            with open(path + ".part", "w", encoding="utf-8") as file:
                file.write(text)
        for path in texts:
            os.replace(path + ".part", path)
    finally:
        for path in texts:
            if os.path.exists(path + ".part"):
                os.remove(path + ".part")
    for path in set(old) - set(texts):
        os.remove(path)


def read_charts(scratch, folder):
    """{path in the folder: text} of the charts that were drawn."""
    charts = {}
    for path in sorted(glob.glob(scratch + "/*.svg")):
        with open(path, encoding="utf-8") as file:
            charts[f"{folder}/{os.path.basename(path)}"] = file.read()
    return charts


def write_page(page, states=None):
    name, folder, module = PAGES[page]
    results = os.environ.get("TED4_RESULTS", "bench")
    table = os.environ.get("TED4_TABLE", f"bench/{name}.txt")
    pages = os.environ.get("TED4_PAGES", "bench")
    module = importlib.import_module("." + module, __package__)
    with tempfile.TemporaryDirectory() as scratch:
        runs = Runs(wanted.read_table(table, Measured),
                    read_states(name, table, results, states, scratch + "/work"),
                    f"{results}/{name}.csv")
        os.mkdir(scratch + "/charts")
        texts = module.write(runs, Charts(scratch + "/charts", folder), results, pages)
        replace_all({f"{results}/{file_name}": text for file_name, text in texts.items()}
                    | read_charts(scratch + "/charts", f"{results}/{folder}"),
                    glob.glob(f"{results}/{folder}/*.svg"))


def wanted_lines(table):
    return [run.line() for run in wanted.read_table(table)]


def times_lines(*paths):
    return [",".join(f"{seconds:.1f}" for seconds in logs.training_times(paths))]


def thin_lines(most, *paths):
    return logs.thinned(paths, int(most))


def predicted_lines(seconds, path):
    return [",".join(logs.predicted(path, float(seconds)))]


def budget_lines(path):
    return [",".join(map(str, budget.read_budget(path)))]


ANSWERS = {"runs": wanted_lines, "times": times_lines, "thin": thin_lines,
           "predicted": predicted_lines, "budget": budget_lines}


def main(name="", *arguments):
    if name in PAGES and len(arguments) <= 1:
        write_page(name, *arguments)
    elif name in ANSWERS and arguments:
        for line in ANSWERS[name](*arguments):
            print(line)
    else:
        sys.exit(__doc__)


if __name__ == "__main__":
    main(*sys.argv[1:])
