#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-2-Clause
"""Asks two decoders that keep the driver contract (conformance/) about changed files, and compares
what they say.

    two_decoders.py [--seconds N] [--seed N] [--ours CMD] [--other CMD] [--mutate CMD] [--keep DIR]
        [FILE...]

Files are changed by the program mutate (mutate_tool.c), one change on top of another while they
stay small. Verdict, identifier, offset and the hashes of tiers T0 to T4 must be equal; a file for
which they are not is kept. A limit (limit.*) of either is not compared. Exit status: 1 when one was
kept.
"""

import argparse
import json
import os
import random
import shlex
import shutil
import subprocess
import sys
import tempfile
import time

TIERS = "T0,T1,T2,T3,T4"
LONGEST = 120                   # seconds for one answer
LARGEST = 4096                  # bytes of a file that is changed again


def main():
    options = parse()
    chance = random.Random(options.seed)
    files = [read(path) for path in options.files or seeds()]
    seen, kept, start = {}, 0, time.monotonic()
    with tempfile.TemporaryDirectory() as folder:
        while time.monotonic() - start < options.seconds:
            changed = change(options, chance, files, folder)
            answers = [answer(command, changed) for command in (options.ours, options.other)]
            said = answers[0].get("error", answers[0].get("result", "no answer"))
            seen[said] = seen.get(said, 0) + 1
            if not same(*answers):
                kept += 1
                keep(options, changed, answers, kept)
            elif answers[0].get("result") == "valid" and os.path.getsize(changed) <= LARGEST:
                files[chance.randrange(len(files))] = read(changed)
    for said in sorted(seen, key=seen.get, reverse=True):
        print("%7d %s" % (seen[said], said))
    print("%d files, %d differences" % (sum(seen.values()), kept))
    return 1 if kept else 0


def parse():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seconds", type=float, default=60)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--ours", type=shlex.split, default=["build/ted4dec"])
    parser.add_argument("--other", type=shlex.split,
                        default=["python3", "conformance/reader/reader.py"])
    parser.add_argument("--mutate", type=shlex.split, default=["build/fuzz/mutate"])
    parser.add_argument("--keep", default="build/two_decoders")
    parser.add_argument("files", nargs="*")
    return parser.parse_args()


def seeds():
    folder = "fuzz/corpus/ted4"
    return [os.path.join(folder, name) for name in sorted(os.listdir(folder))]


def read(path):
    with open(path, "rb") as file:
        return file.read()


def change(options, chance, files, folder):
    """Path of a changed copy of one of the files."""
    source, target = os.path.join(folder, "from.ted4"), os.path.join(folder, "to.ted4")
    with open(source, "wb") as file:
        file.write(chance.choice(files))
    subprocess.run(options.mutate + [str(chance.randrange(1 << 31)), source, target], check=True)
    return target


def answer(command, path):
    """What a decoder says; {} when it says nothing that can be used."""
    try:
        run = subprocess.run(command + ["--ted4-run", path, "--tiers", TIERS], capture_output=True,
                             timeout=LONGEST, check=False)
        said = json.loads(run.stdout)
    except (subprocess.TimeoutExpired, ValueError):
        return {}
    return said if run.returncode == 0 and isinstance(said, dict) else {}


def same(a, b):
    if "limit" in (a.get("result"), b.get("result")):
        return True
    return bool(a) and all(a.get(name) == b.get(name)
                           for name in ("result", "error", "offset", "tiers"))


def keep(options, path, answers, number):
    os.makedirs(options.keep, exist_ok=True)
    name = os.path.join(options.keep, "seed%d-%d" % (options.seed, number))
    shutil.copy(path, name + ".ted4")
    with open(name + ".json", "w", encoding="ascii") as file:
        json.dump(answers, file, indent=1)
    print("differ: %s.ted4: %s | %s" % (name, brief(answers[0]), brief(answers[1])), flush=True)


def brief(said):
    return " ".join(str(said.get(name))
                    for name in ("result", "error", "offset")) if said else "no answer"


if __name__ == "__main__":
    sys.exit(main())
