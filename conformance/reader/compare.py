#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-2-Clause
"""Compares the reader with another decoder on streams that neither has seen: random ones
(sample.py), valid and broken.

    compare.py --decoder 'CMD' [--seeds FIRST:END] [--broken N] [--keep FOLDER] [FILE.ted4 ...]

CMD follows the contract of ../README.md. Odd seeds give streams of profile Compact. For each seed
(or file), T0 to T5 of the whole stream are compared, then verdict, identifier and offset of N
broken ones. A difference is printed and its stream stored in FOLDER (default: here). The exit
status is 1 if there was one.
"""

import argparse
import json
import os
import random
import shlex
import struct
import subprocess
import sys
import tempfile

import reader
from sample import chunk, random_stream

QUERIES = [{"t": [0, 1], "cam": [0, 0, 0]}, {"t": [1, 3], "cam": [1, -2.5, 3]},
           {"t": [1, 1], "cam": [-8, 0.25, 1]},
           {"t": [16777214, 16777215], "cam": [2.0 ** 100, 0, 0]}, {"t": [3, 2], "cam": [0, 0, 0]}]


def main():
    parser = argparse.ArgumentParser(
        description="Compares the reader with another decoder on drawn streams.")
    parser.add_argument("--decoder", required=True, type=shlex.split,
                        help="command of the other decoder")
    parser.add_argument("--seeds", default="0:20", help="FIRST:END")
    parser.add_argument("--broken", type=int, default=5, help="broken streams of each whole one")
    parser.add_argument("--keep", default=".", metavar="FOLDER",
                        help="where streams go that show a difference")
    parser.add_argument("files", nargs="*", help="streams instead of seeds")
    options = parser.parse_args()
    first, end = map(int, options.seeds.split(":"))
    compared = different = 0
    with tempfile.TemporaryDirectory() as folder:
        for name in options.files or range(first, end):
            data = reader.read(name) if options.files else random_stream(name,
                                                                         compact=name % 2 == 1)
            rng = random.Random(str(name))
            for number in range(options.broken + 1):
                case = broken(rng, data) if number else data
                compared += 1
                if not agree(options.decoder, folder, case, whole=number == 0):
                    different += 1
                    keep(os.path.join(options.keep,
                                      "differs-%s-%d.ted4" % (os.path.basename(str(name)), number)),
                         case)
    print("%d streams compared, %d differ" % (compared, different))
    return 1 if different else 0


def keep(name, data):
    print("kept: " + name)
    with open(name, "wb") as file:
        file.write(data)


def agree(command, folder, data, whole):
    """Whether both decoders give the same answer for these bytes."""
    path, queries = os.path.join(folder, "s.ted4"), os.path.join(folder, "q.json")
    with open(path, "wb") as file:
        file.write(data)
    with open(queries, "w", encoding="utf-8") as file:
        json.dump(QUERIES, file)
    arguments = ["--ted4-run", path]
    if whole:
        arguments += ["--tiers", "T0,T1,T2,T3,T4,T5", "--queries", queries]
    ours = reader.run(reader.parse(arguments))
    theirs = json.loads(
        subprocess.run(command + arguments, stdout=subprocess.PIPE, check=True).stdout)
    if ours["result"] == theirs["result"] == "valid" and not whole:
        return True
    if ours != theirs:
        print("reader: %s\nother:  %s" % (json.dumps(ours), json.dumps(theirs)))
    return ours == theirs


def broken(rng, data):
    """One or two changes. After most of them the hashes of chunks are repaired, so that the stream
    reaches pass 2."""
    chunks, at = [], 12
    while at < len(data):
        flags, size = struct.unpack_from("<II", data, at + 4)
        chunks.append([data[at:at + 4], bytearray(data[at + 12:at + 12 + size]), flags])
        at += 20 + size
    for _ in range(rng.choice((1, 1, 1, 2))):
        change(rng, chunks)
    result = data[:12] + b"".join(chunk(kind, bytes(payload), flags)
                                  for kind, payload, flags in chunks)
    if rng.random() < 0.1:
        result = result[:rng.randrange(len(result) + 1)]
    if rng.random() < 0.1 and result:
        position = rng.randrange(len(result))
        result = result[:position] + bytes([rng.randrange(256)]) + result[position + 1:]
    return result


def change(rng, chunks):
    """Most of the time a change of one payload byte; otherwise of a payload's size, of flags, or of
    the list of chunks."""
    i = rng.randrange(len(chunks))
    payload, way = chunks[i][1], rng.random()
    if way < 0.8 and payload:
        position = rng.randrange(min(len(payload), rng.choice((8, 100, 1 << 30))))
        payload[position] = rng.choice(
            (payload[position] ^ 1 << rng.randrange(8), rng.randrange(256), 0, 255, 128))
    elif way < 0.85:
        del payload[rng.randrange(len(payload) + 1):]
    elif way < 0.9:
        payload += bytes(rng.randint(1, 5))
    elif way < 0.92:
        chunks[i][2] = rng.choice((0, 2, 3, 5, 1 << 31))
    elif way < 0.94:
        chunks.insert(i, [rng.choice((b"META", b"xabc", b"HEAD", b"TILE", b"a-bc")),
                          bytearray(rng.randrange(3)), rng.choice((0, 1, 2, 3))])
    elif way < 0.96:
        del chunks[i]
    elif way < 0.98:
        chunks.insert(i, [chunks[i][0], bytearray(payload), chunks[i][2]])
    else:
        j = rng.randrange(len(chunks))
        chunks[i], chunks[j] = chunks[j], chunks[i]


if __name__ == "__main__":
    sys.exit(main())
