#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-2-Clause
"""A second TED4 decoder, written from the specification alone: command line.

    reader.py --ted4-capabilities
    reader.py --ted4-run FILE [--tiers T0,T1,...] [--queries FILE.json]
        [--knob max_alloc_total=BYTES] [--knob max_work=STEPS] [--dump DIR]

Prints one JSON document on standard output. The exit status is 0 for every verdict on the file,
including a refusal.
"""

import argparse
import hashlib
import json
import os
import sys

from decode import Model
from dumps import TIERS
from floats import f32_round
from reconstruct import Anchors, Query, records
from verdict import Refusal
from xxh3 import xxh3_128

CAPABILITIES = {"protocol": 1, "name": "ted4-reader", "version": "1.0",
                "spec": "1.0 and draft 1.1", "profiles": ["Main", "Compact"], "max_level": 2,
                "tiers": ["T0", "T1", "T2", "T3", "T4", "T5"], "class": "X", "strict": True,
                "declines": [], "knobs": ["max_alloc_total", "max_work"]}


def main(arguments):
    options = parse(arguments)
    if options.ted4_capabilities:
        answer = CAPABILITIES
    else:
        answer = run(options)
    json.dump(answer, sys.stdout)
    print()


def parse(arguments):
    parser = argparse.ArgumentParser(
        description="A second TED4 decoder, written from the specification alone.")
    what = parser.add_mutually_exclusive_group(required=True)
    what.add_argument("--ted4-capabilities", action="store_true",
                      help="say what this decoder can do")
    what.add_argument("--ted4-run", metavar="FILE", help="decode the file, or - for standard input")
    parser.add_argument("--tiers", type=tier_list, default=[], metavar="T0,T1,..",
                        help="tiers to hash (annex J)")
    parser.add_argument("--queries", metavar="FILE.json",
                        help='queries of T5: [{"t": [num, den], "cam": [x, y, z]}, ...]')
    parser.add_argument("--knob", action="append", default=[], type=knob, metavar="NAME=VALUE",
                        help="max_alloc_total=BYTES, max_work=STEPS")
    parser.add_argument("--dump", metavar="DIR",
                        help="write the byte strings of the tiers into this folder")
    return parser.parse_args(arguments)


def tier_list(text):
    names = text.split(",")
    if not set(names) <= set(CAPABILITIES["tiers"]):
        raise argparse.ArgumentTypeError("tiers are T0 to T5")
    return sorted(set(names))


def knob(text):
    name, _, value = text.partition("=")
    if name not in CAPABILITIES["knobs"] or not value.isdigit():
        raise argparse.ArgumentTypeError("knobs are max_alloc_total=BYTES and max_work=STEPS")
    return name, int(value)


def run(options):
    """The answer to --ted4-run."""
    try:
        data = sys.stdin.buffer.read() if options.ted4_run == "-" else read(options.ted4_run)
    except OSError as error:
        print("reader.py: %s" % error, file=sys.stderr)
        return {"result": "io", "error": "io.read"}
    try:
        knobs = dict(options.knob)
        model = Model(data, knobs.get("max_alloc_total"), knobs.get("max_work"))
    except Refusal as refusal:
        return refusal_answer(refusal)
    except MemoryError:
        return refusal_answer(Refusal("limit.memory"))
    queries = read_queries(options.queries) if options.queries else []
    return {"result": "valid",
            "tiers": {name: tier(model, name, queries, options.dump) for name in options.tiers}}


def read(path):
    with open(path, "rb") as file:
        return file.read()


def refusal_answer(refusal):
    answer = {"result": refusal.result, "error": refusal.error}
    if refusal.offset is not None:
        answer["offset"] = refusal.offset
    return answer


def read_queries(path):
    """R-DMP-061. JSON numbers are read as binary64 first; a number that is exact in binary32 is not
    changed by that."""
    return [Query(q["t"][0], q["t"][1], [f32_round(c) for c in q["cam"]])
            for q in json.loads(read(path))]


def tier(model, name, queries, folder):
    """The answer for one tier; for T5 a list with one entry per query."""
    if name != "T5":
        return describe(TIERS[name](model), name, folder)
    anchors = Anchors(model)
    answers = []
    for number, query in enumerate(queries):
        try:
            answers.append(describe(records(anchors, query), "T5-%d" % number, folder))
        except Refusal as refusal:
            answers.append({"error": refusal.error})
    return answers


def describe(string, name, folder):
    """R-DMP-002."""
    if folder:
        with open(os.path.join(folder, name + ".bin"), "wb") as file:
            file.write(string)
    return {"bytes": len(string), "xxh3": xxh3_128(string).hex(),
            "sha256": hashlib.sha256(string).hexdigest()}


if __name__ == "__main__":
    main(sys.argv[1:])
