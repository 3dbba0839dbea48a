#!/usr/bin/env python3
# line_decoder.py - a decoder that speaks the line protocol (conformance/adapters/line.py), as a
# board does that has booted: a wrapper of $TED4DEC.
#     line_decoder.py WAY [FILE [NUM DEN X Y Z]...]      WAY: good, or how its lines are wrong
# SPDX-License-Identifier: BSD-2-Clause
import json
import os
import subprocess
import sys
import tempfile

way, arguments = sys.argv[1], sys.argv[2:]
print("boot 3.1\nTED4 board\n")
if not arguments:
    print("TED4-1 decoder board 3.1 31 X")
else:
    numbers = arguments[1:]
    queries = [{"t": [int(numbers[i]), int(numbers[i + 1])],
                "cam": [float(x) for x in numbers[i + 2:i + 5]]} for i in range(0, len(numbers), 5)]
    with tempfile.NamedTemporaryFile("w", suffix=".json", encoding="ascii") as file:
        json.dump(queries, file)
        file.flush()
        said = json.loads(subprocess.run([os.environ["TED4DEC"], "--ted4-run", arguments[0],
                                          "--tiers", "T0,T1,T2,T3,T4,T5", "--queries", file.name],
                                         stdout=subprocess.PIPE, check=True).stdout)
    for tier, hashes in sorted(said.get("tiers", {}).items()):
        for i, one in enumerate(hashes if tier == "T5" else [hashes]):
            kind = "sha256" if i % 2 else "xxh3"
            print("TED4-1 valid %s %s" % (tier, one.get("error")
                                          or (one[kind][:-1] + "x" if way == "no-hex"
                                              else one[kind])))
        if way == "two-verdicts":
            print("TED4-1 limit limit.memory")
    if said["result"] != "valid":
        print("TED4-1", said["result"], said["error"], said.get("offset", ""))
if way != "no-end":
    print("TED4-1 end")
