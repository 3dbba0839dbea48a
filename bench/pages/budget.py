"""Bytes of a file by kind of syntax element, from `ted4info --budget --json`.
SPDX-License-Identifier: BSD-2-Clause"""
import json
import sys

# Columns b_* of the tables of rows. mask: temporal and offset masks with their probabilities.
# frame: everything that frames chunks, tiles and the file. Their sum is the file.
KINDS = "HEAD NETE NETR BANK POSN mask feature scaling offset phi tau frame".split()
FRAMES = ("frame", "tile_index", "size")


def kind_of(chunk, element):
    if element in FRAMES or chunk in ("file", "ENDS"):
        return "frame"
    if chunk != "TILE":
        return chunk
    element = element.split("_substream")[0]
    return "mask" if element.endswith("_prob") else element


def read_budget(path):
    """Bytes of each kind, in the order of KINDS. An element without a kind ends the program."""
    with open(path, encoding="utf-8") as file:
        elements = json.load(file)["budget"]
    sums = dict.fromkeys(KINDS, 0)
    for element in elements:
        kind = kind_of(element["chunk"], element["element"])
        if kind not in sums:
            sys.exit(f"{path}: {kind}: an element without a column")
        sums[kind] += element["bytes"]
    return list(sums.values())
