#!/usr/bin/env python3
# class_t.py - decoders that claim class T, some of them wrongly: the answers and records of
# $TED4DEC, changed by as much as WAY says.
#     class_t.py WAY ARGUMENTS OF THE CONTRACT...
# The thresholds of a file are those of the vector with its hash in
# conformance/tolerance/thresholds.csv. Run in the project's root, by bad_decoder.sh.
# SPDX-License-Identifier: BSD-2-Clause
import csv
import hashlib
import json
import os
import struct
import subprocess
import sys

# For each group of a record: its first number, and how many it has.
GROUPS = {"scale": (3, 3), "rotation": (6, 4), "opacity": (10, 1), "colour": (11, 3)}


def thresholds(path):
    """For the queries of a file: {query: {group: (peak, rms)}}"""
    with open(path, "rb") as f:
        sha = hashlib.sha256(f.read()).hexdigest()
    with open("conformance/SUITE.json", encoding="utf-8") as f:
        ids = [v["id"] for v in json.load(f)["vector"] if v["sha256"] == sha]
    with open("conformance/tolerance/thresholds.csv", newline="", encoding="utf-8") as f:
        rows = [r for r in csv.DictReader(f) if r["vector"] in ids]
    return {int(r["query"]): {g: (2.0 ** int(r[g + "_peak"]), 2.0 ** int(r[g + "_rms"]))
                              for g in GROUPS} for r in rows}


def shift(record, group, amount):
    """A record whose deviation in a group is amount, or close to it."""
    first, count = GROUPS[group]
    if group == "scale":
        record[first + 1] *= 1 + amount
    elif group == "rotation":
        # Away from 0, where neither q nor -q is nearer; the largest entry is left alone.
        i = min(range(first, first + count), key=lambda j: abs(record[j]))
        record[i] += amount if record[i] >= 0 else -amount
    else:
        record[first] += amount if record[first] < 0.5 else -amount


def change(way, records, bound):
    for group in GROUPS:
        peak, rms = bound[group]
        if way == "inside":
            for r in records:
                shift(r, group, 0.75 * rms)
        elif way == "beyond-" + group:
            shift(records[len(records) // 2], group, 1.25 * peak)
        elif way == "rms-" + group and rms < peak:
            for r in records:
                shift(r, group, 1.25 * rms)
    if way == "nan":
        records[-1][10] = float("nan")
    if way == "short":
        records.pop()


def answer_records(way, path, bound):
    """Changes the file of a query; returns what the answer has to say about it."""
    with open(path, "rb") as f:
        records = [list(r) for r in struct.iter_unpack("<14f", f.read())]
    change(way, records, bound)
    data = b"".join(struct.pack("<14f", *r) for r in records)
    with open(path, "wb") as f:
        f.write(data)
    return {"bytes": len(data), "sha256": hashlib.sha256(data).hexdigest()}


def main():
    way, arguments = sys.argv[1], sys.argv[2:]
    answer = json.loads(subprocess.run([os.environ["TED4DEC"]] + arguments, stdout=subprocess.PIPE,
                                       check=True).stdout)
    if arguments[0] == "--ted4-capabilities":
        answer["class"] = "T"
    elif "T5" in answer.get("tiers", {}) and "--dump" in arguments:
        folder = arguments[arguments.index("--dump") + 1]
        bounds = thresholds(arguments[1])
        for i, entry in enumerate(answer["tiers"]["T5"]):
            path = os.path.join(folder, "T5-%d.bin" % i)
            if "error" in entry:
                if way == "more" and entry["error"] == "rec.non-finite":
                    answer["tiers"]["T5"][i] = {"sha256": "0" * 64}
                continue
            if way == "less":
                answer["tiers"]["T5"][i] = {"error": "rec.non-finite"}
            elif i in bounds:
                answer["tiers"]["T5"][i] = answer_records(way, path, bounds[i])
            if way == "no-dump":
                answer["tiers"]["T5"][i] = {"sha256": "0" * 64}
                os.unlink(path)
            if way == "other-dump":
                answer["tiers"]["T5"][i]["sha256"] = "0" * 64
    print(json.dumps(answer))


main()
