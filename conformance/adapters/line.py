#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-2-Clause
"""The contract of conformance/README.md for a decoder that prints lines, such as firmware behind a
serial port.

    ted4conf run --decoder 'python3 conformance/adapters/line.py CMD'

CMD is run as `CMD` (to name itself) and as `CMD FILE [NUM DEN X Y Z]...` (a file, and queries). Of
what it prints on stdout, only lines that begin with "TED4-1 " count:

    TED4-1 decoder NAME VERSION LEVEL CLASS     LEVEL: the highest; CLASS: X, or - (no T5)
    TED4-1 valid T3 HEX                         one line per tier; T5: one line per query, in
                                                order, with HEX or why it has no result
    TED4-1 invalid ID OFFSET
    TED4-1 unsupported ID OFFSET
    TED4-1 limit ID
    TED4-1 end                                  the last line; without it there is no answer

HEX: 32 digits of XXH3-128, or 64 of SHA-256.
"""

import json
import subprocess
import sys

MARK = "TED4-1 "


class NoAnswer(Exception):
    """The decoder's output is not an answer."""


def lines(command, arguments):
    run = subprocess.run(command + arguments, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                         check=False)
    said = [line.strip()[len(MARK):].split()
            for line in run.stdout.decode("ascii", "replace").splitlines() if line.startswith(MARK)]
    if run.returncode != 0 or not said or said[-1] != ["end"]:
        raise NoAnswer("exit status %d, %d lines" % (run.returncode, len(said)))
    return said[:-1]


def capabilities(command):
    said = [line for line in lines(command, []) if line[0] == "decoder"]
    if len(said) != 1 or len(said[0]) != 5:
        raise NoAnswer("no line of a decoder")
    _, name, version, level, arithmetic = said[0]
    exact = arithmetic == "X"
    return {"protocol": 1, "name": name, "version": version, "spec": "1.0", "profiles": ["Main"],
            "max_level": int(level),
            "tiers": ["T0", "T1", "T2", "T3", "T4"] + (["T5"] if exact else []),
            "class": "X" if exact else None, "strict": True, "declines": [],
            "knobs": []}


def hashed(text):
    if len(text) not in (32, 64) or text.strip("0123456789abcdef"):
        raise NoAnswer("not a hash: %s" % text)
    return {"xxh3" if len(text) == 32 else "sha256": text}


def answer(said):
    verdicts = {line[0] for line in said if line[0] != "decoder"}
    if len(verdicts) != 1:
        raise NoAnswer("not one verdict: %s" % sorted(verdicts))
    result = verdicts.pop()
    said = [line for line in said if line[0] == result]
    if result != "valid":
        if len(said) != 1 or len(said[0]) < 2:
            raise NoAnswer("not one line of %s" % result)
        reply = {"result": result, "error": said[0][1]}
        return reply if result == "limit" else dict(reply, offset=int(said[0][2]))
    tiers = {}
    for _, tier, text in said:
        if tier == "T5":
            tiers.setdefault(tier, []).append({"error": text} if "." in text else hashed(text))
        elif tier in tiers:
            raise NoAnswer("%s twice" % tier)
        else:
            tiers[tier] = hashed(text)
    return {"result": result, "tiers": tiers}


def run(command, path, options):
    queries = []
    if "--queries" in options:
        with open(options[options.index("--queries") + 1], encoding="ascii") as file:
            queries = [repr(x) for q in json.load(file) for x in q["t"] + q["cam"]]
    return answer(lines(command, [path] + queries))


def main(arguments):
    at = next((i for i, text in enumerate(arguments) if text.startswith("--ted4-")), 0)
    command = arguments[:at]
    if not command:
        print(__doc__, file=sys.stderr)
        return 3
    try:
        reply = (capabilities(command) if arguments[at] == "--ted4-capabilities"
                 else run(command, arguments[at + 1], arguments[at + 2:]))
    except (NoAnswer, OSError, ValueError, IndexError) as why:
        print("line.py: no answer: %s" % why, file=sys.stderr)
        return 1
    print(json.dumps(reply))
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
