"""Results of rows that no longer exist: bench/earlier.csv, for definitions of bars that today's
rows cannot judge.
SPDX-License-Identifier: BSD-2-Clause"""
import csv


def earlier(results, name):
    """What earlier rows measured, with the commit that holds them, and whether that met the bar as
    it was then; ("", None) where nothing is kept."""
    try:
        with open(f"{results}/earlier.csv", encoding="utf-8") as file:
            for row in csv.DictReader(file):
                if row["name"] == name:
                    return (f"{row['measured']} (rows of commit {row['commit']})",
                            row["met"] == "yes")
    except FileNotFoundError:
        pass
    return "", None
