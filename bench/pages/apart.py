"""How far apart the same training ends on other machines: with older sources, by bench/apart.csv;
with today's, by bench/machines.csv.
SPDX-License-Identifier: BSD-2-Clause"""
import csv

from .words import fixed, signed


def read_rows(results, name):
    try:
        with open(f"{results}/{name}", encoding="utf-8") as file:
            return list(csv.DictReader(file))
    except FileNotFoundError:
        return []


def today(results):
    """What machines.csv says of today's trainings, as a sentence; "" without it."""
    rows = [row for row in read_rows(results, "machines.csv") if row["verdict"] == "passed"]
    same = [row for row in rows if row["agrees"] == "same"]
    if not same:
        return ""
    hashes = {(row["hash"], row["variants"]) for row in same}
    others = len(rows) - len(same)
    return (f"With today's sources, {len(same)} builds with fused multiply-add end with "
            f"{'the same bytes' if len(hashes) == 1 else f'{len(hashes)} different files'}"
            + (f"; {others} without it may differ" if others else "")
            + " ([machines.md](machines.md)).")


def section(page, runs, results):
    """Of the rows that are still those of the sources that apart.csv names."""
    rows = [(runs.find(row["tag"]), row) for row in read_rows(results, "apart.csv")]
    rows = [(run, row) for run, row in rows
            if row["sources"] in run.text("key").replace(".", "-").split("-")]
    if not rows:
        return
    page.heading("Machines")
    gaps = [(float(row["psnr"]) - run.number("psnr"),
             100 * (float(row["bytes"]) / run.number("bytes") - 1)) for run, row in rows]
    most = [max(abs(gap[k]) for gap in gaps) for k in (0, 1)]
    page.prose(f"""Before the present sources, trainings gave the same bytes only for the same
        build on the same machine. Rows of such sources, trained again by another build of them, end
        up to {most[0]:.2f} dB and {most[1]:.1f} % of the bytes apart.
        {today(results)}""")
    page.table("run", "PSNR dB", "bytes", "other build", "PSNR dB", "bytes", "difference")
    for (run, row), (psnr, rate) in zip(rows, gaps):
        page.row(run.name(), fixed(run.number("psnr"), 2), run.text("bytes"), row["build"],
                 fixed(float(row["psnr"]), 2), row["bytes"],
                 signed(psnr, 2, " dB, ") + signed(rate, 1, " %"))
