#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-2-Clause
"""Tests that the program of annex L judges the zlib streams of the vectors as their descriptors
say, and that without one of its checks, or with it misread, it judges some stream otherwise. The
exceptions, which no stream shows, are those of GAPS.md. Prints lines as a cmocka program does; run
in the project's root, by tests/docs/test_inflate_checks.sh. CC: the compiler."""

import ctypes
import glob
import json
import os
import re
import struct
import subprocess
import sys
import tempfile

ANNEX = "spec/annex-l-deflate.md"
VECTORS = ("conformance/vectors/*/*/*-blocks-*.json",
           "conformance/vectors/invalid/networks/NEG-deflate-BANK-*.json")
MARGIN = 1 << 20                # bytes before and behind the output, for programs without a check
WRAPPER = """
int judge(const uint8_t *in, size_t n_in, uint8_t *out, size_t n_out)
{
    return inflate_exactly(in, n_in, out, n_out);
}
"""

# Name, text of the program, what it becomes. sum and alone: see program().
FAULTS = (
    ("a code is over-full", "return left == 0 ||", "return left <= 0 ||"),
    ("a code is incomplete", "return left == 0 ||", "return left >= 0 ||"),
    ("a single code is longer than a bit", "k == 1 && c->count[1] == 1) || (none",
     "k == 1) || (none"),
    ("no single code", "(single && k == 1 && c->count[1] == 1)", "0"),
    ("no empty code", "(none && k == 0)", "0"),
    ("code length code over-full", "if (!make_code(&lengths, length, 19, 0, 0))",
     "if (!make_code(&lengths, length, 19, 0, 0) && sum > 0)"),
    ("code length code incomplete", "if (!make_code(&lengths, length, 19, 0, 0))",
     "if (!make_code(&lengths, length, 19, 0, 0) && sum < 0)"),
    ("literal code over-full", "!make_code(literal, length, n_literal, 1, 0)",
     "(!make_code(literal, length, n_literal, 1, 0) && sum > 0)"),
    ("literal code incomplete", "!make_code(literal, length, n_literal, 1, 0)",
     "(!make_code(literal, length, n_literal, 1, 0) && sum < 0)"),
    ("no single literal code", "make_code(literal, length, n_literal, 1, 0)",
     "make_code(literal, length, n_literal, 0, 0)"),
    ("distance code over-full", "!make_code(distance, length + n_literal, n_distance, 1, 1)",
     "(!make_code(distance, length + n_literal, n_distance, 1, 1) && sum > 0)"),
    ("distance code incomplete", "!make_code(distance, length + n_literal, n_distance, 1, 1)",
     "(!make_code(distance, length + n_literal, n_distance, 1, 1) && sum < 0)"),
    ("bits without a symbol", "    b->bad = 1;\n    return -1;", "    return -1;"),
    ("bits without a symbol are the first", "    b->bad = 1;\n    return -1;",
     "    return c->symbol[0];"),
    ("a single code has no bit to be wrong", "int value = 0, first = 0, k = 0;",
     "int value = 0, first = 0, k = 0;\n"
     "    if (c->count[1] == 1 && c->alone) {\n"
     "        (void)next_bits(b, 1);\n        return c->symbol[0];\n    }"),
    ("287 and 288 literal codes", "n_literal > 286 ||", ""),
    ("287 literal codes", "n_literal > 286", "n_literal > 287"),
    ("31 and 32 distance codes", "|| n_distance > 30", ""),
    ("31 distance codes", "n_distance > 30", "n_distance > 31"),
    ("29 distance codes", "n_distance > 30", "n_distance > 29"),
    ("repeat as the first", "if (symbol == 16 && i == 0)", "if (0)"),
    ("repeat beyond the end", "if (i + times > n_literal + n_distance)", "if (0)"),
    ("repeat is cut off", "if (i + times > n_literal + n_distance)\n            b->bad = 1;",
     "if (i + times > n_literal + n_distance)\n            times = n_literal + n_distance - i;"),
    ("repeat ends with the literals", "symbol == 16 && i > 0 ?",
     "symbol == 16 && i > 0 && i != n_literal ?"),
    ("symbols 286 and 287", "if (s > 285)", "if (0)"),
    ("symbol 286", "s > 285", "s > 286"),
    ("distance symbols 30 and 31", "b->bad || d > 29", "b->bad"),
    ("distance symbol 30", "d > 29", "d > 30"),
    ("distance before the first byte", "back > *at ||", ""),
    ("distance to the first byte", "back > *at", "back >= *at"),
    ("distance 32768", "back > *at", "back > *at || back > 32767"),
    ("match is cut off", "if (b->bad || back > *at || length > n_out - *at)",
     "if (length > n_out - *at)\n            length = n_out - *at;\n"
     "        if (b->bad || back > *at)"),
    ("NLEN", "n + check != 65535 ||", ""),
    ("stored block of no bytes", "n + check != 65535", "n == 0 || n + check != 65535"),
    ("stored block is cut off",
     "|| n > n_out - *at)\n        b->bad = 1;\n    for (; n > 0 && !b->bad; n--)\n"
     "        out[(*at)++] =",
     ")\n        b->bad = 1;\n    for (uint8_t none; n > 0 && !b->bad; n--)\n"
     "        *(*at < n_out ? &out[(*at)++] : &none) ="),
    ("CM", "in[0] % 16 != 8 ||", ""),
    ("CINFO", "in[0] / 16 > 7 ||", ""),
    ("FDICT", "(in[1] & 32) != 0 ||", ""),
    ("FCHECK", "|| (256 * in[0] + in[1]) % 31 != 0", ""),
    ("block type 3", "        else\n            b.bad = 1;\n        if ((type",
     "        if ((type"),
    ("no last block", "while (!last && !b.bad)", "while (!last && !b.bad && at < n_out)"),
    ("Adler-32", "b.bad = 1;\n    return", ";\n    return"),
    ("output too short", "&& at == n_out &&", "&&"),
    ("bytes left over", "&& b.at == b.n;", ";"),
)
# Those of GAPS.md.
UNTOLD = (
    ("symbol 256 without a code", "length[256] == 0 ||", ""),
    ("empty literal code", "make_code(literal, length, n_literal, 1, 0)",
     "make_code(literal, length, n_literal, 1, 1)"),
    ("single code length code", "make_code(&lengths, length, 19, 0, 0)",
     "make_code(&lengths, length, 19, 1, 0)"),
    ("empty code length code", "make_code(&lengths, length, 19, 0, 0)",
     "make_code(&lengths, length, 19, 0, 1)"),
    ("match beyond the values", "|| length > n_out - *at", ""),
    ("stored block beyond the values", "|| n > n_out - *at", ""),
    ("end of the input", "i++, b->at++)\n",
     "i++, b->at++)\n        if (b->at >= b->n && b->at < b->n + 100000)\n"
     "            continue;\n        else\n"),
)


def program():
    """The text of annex L, with two additions: sum is below 0 if the last code was over-subscribed,
    above 0 if it was incomplete; and a code knows whether it is alone, one of length 1."""
    with open(ANNEX, encoding="utf-8") as f:
        text = "".join(re.findall(r"^```c\n(.*?)^```$", f.read(), re.DOTALL | re.MULTILINE))
    text = text.replace("struct prefix_code {\n",
                        "static int sum;\nstruct prefix_code {\n    int alone;\n")
    return text.replace("    return left == 0 ||",
                        "    sum = left;\n    c->alone = k == 1 && c->count[1] == 1;\n"
                        "    return left == 0 ||")


def streams():
    """id: (zlib stream of BANK, bytes of output, whether it is valid)"""
    found = {}
    for path in sorted(p for pattern in VECTORS for p in glob.glob(pattern)):
        with open(path, encoding="utf-8") as f:
            d = json.load(f)
        with open(path[:-4] + "ted4", "rb") as f:
            data = f.read()
        at, n_out = 12, 0
        while at < len(data):
            kind, size = data[at:at + 4], struct.unpack_from("<I", data, at + 8)[0]
            payload = data[at + 12:at + 12 + size]
            if kind == b"HEAD":
                rows, dim = struct.unpack_from("<IH", payload, 12)
                n_out = 4 * rows * dim
            if kind == b"BANK" and payload[0] == 1:
                found[d["id"]] = payload[1:], n_out, d["expect"]["result"] == "valid"
            at += size + 20
    return found


def verdicts(text, folder, all_streams):
    """The streams that a program judges otherwise than their descriptors say."""
    verdicts.n += 1
    source, library = f"{folder}/{verdicts.n}.c", f"{folder}/{verdicts.n}.so"
    with open(source, "w", encoding="utf-8") as f:
        f.write("#include <stddef.h>\n#include <stdint.h>\n#include <string.h>\n" + text + WRAPPER)
    subprocess.run([*os.environ.get("CC", "cc").split(), "-std=c11", "-O1", "-w", "-shared",
                    "-fPIC", "-fno-strict-overflow", source, "-o", library], check=True)
    judge = ctypes.CDLL(library).judge
    judge.argtypes = ctypes.c_char_p, ctypes.c_size_t, ctypes.c_void_p, ctypes.c_size_t
    wrong = []
    for name, (stream, n_out, valid) in all_streams.items():
        out = ctypes.create_string_buffer(n_out + 2 * MARGIN)
        said = judge(stream, len(stream), ctypes.addressof(out) + MARGIN, n_out)
        if (said == 1 and len(stream) < n_out) != valid:         # the length: R-NET-001
            wrong.append(name)
    return wrong


verdicts.n = 0


def changed(text, fault):
    name, old, new = fault
    if text.count(old) != 1:
        raise AssertionError(f"{name}: the text occurs {text.count(old)} times")
    return text.replace(old, new)


def test_whole(text, folder, all_streams):
    assert len(all_streams) > 50, len(all_streams)
    assert verdicts(text, folder, all_streams) == []


def test_told(text, folder, all_streams):
    missed = [f[0] for f in FAULTS if not verdicts(changed(text, f), folder, all_streams)]
    assert missed == [], missed


def test_untold(text, folder, all_streams):
    told = [f[0] for f in UNTOLD if verdicts(changed(text, f), folder, all_streams)]
    assert told == [], f"GAPS.md says that no stream tells {told}"


def main():
    tests = (("the_program_judges_as_descriptors_say", test_whole),
             ("each_check_is_told", test_told), ("the_others_are_not", test_untold))
    failed = 0
    print(f"[==========] Running {len(tests)} test(s).")
    with tempfile.TemporaryDirectory() as folder:
        arguments = program(), folder, streams()
        for name, test in tests:
            print(f"[ RUN      ] {name}")
            try:
                test(*arguments)
                print(f"[       OK ] {name}")
            except AssertionError as e:
                print(f"{e}\n[  FAILED  ] {name}")
                failed += 1
    print(f"[==========] {len(tests)} test(s) run.")
    print(f"[  PASSED  ] {len(tests) - failed} test(s).")
    return failed > 0


if __name__ == "__main__":
    sys.exit(main())
