# SPDX-License-Identifier: BSD-2-Clause
"""POSN (chapter 8), judged anchor after anchor (R-POS-003)."""

import struct

from adaptive import Rest, decode_tree
from floats import f16_sound, f16_values
from verdict import require


def spread(byte):
    """Bit i of a byte to bit 3 i."""
    return sum((byte >> i & 1) << 3 * i for i in range(8))


SPREAD = [spread(byte) for byte in range(256)]


def image(pattern):
    """The order-preserving image of an f16 pattern."""
    return pattern + 0x8000 if pattern < 0x8000 else 0xFFFF - pattern


def morton(patterns):
    """The code of 48 bits: bit i of the image of x, y, z is bit 3 i + 2, 3 i + 1, 3 i."""
    code = 0
    for shift, pattern in zip((2, 1, 0), patterns):
        v = image(pattern)
        code |= (SPREAD[v & 255] | SPREAD[v >> 8] << 24) << shift
    return code


class Positions:
    """`patterns`: 3 N f16 patterns; `values`: the same as numbers; `fixed`: X = p 2^24,
    integers."""

    def __init__(self, payload, n):
        if payload.compact:
            self.patterns = read_tree(payload, n)
        else:
            self.read_array(payload, n)
        self.values = f16_values(self.patterns)
        self.fixed = [int(v * 16777216.0) for v in self.values]

    def read_array(self, payload, n):
        """8.1."""
        start = payload.at
        self.patterns = payload.numbers("position", 2, 3 * n)
        last = -1
        for i in range(0, 3 * n, 3):
            anchor = self.patterns[i:i + 3]
            for j, pattern in enumerate(anchor):
                require(f16_sound(pattern), "pos.value", start + 2 * (i + j))           # R-POS-001
                require(pattern & 0x7FFF <= 0x3C00, "pos.range", start + 2 * (i + j))  # 0x3C00 is 1
            code = morton(anchor)
            require(code > last, "pos.order", start + 2 * i)                            # R-POS-002
            last = code


def read_tree(payload, n):
    """8.2: the patterns of 3 N coordinates."""
    start = payload.at
    depth = payload.number("grid", 1)
    require(depth in (6, 7, 8, 9, 10, 11, 12, 16), "pos.grid", start)                   # R-POS-004
    rest = Rest(payload, "tree_substream", n)
    keys = decode_tree(rest, depth, n)
    rest.finish()
    patterns = [coordinate(place_of(key, depth, 2 - j), depth) for key in keys for j in range(3)]
    for pattern in patterns:
        require(f16_sound(pattern), "pos.value", rest.start)                            # R-POS-001
        require(pattern & 0x7FFF <= 0x3C00, "pos.range", rest.start)
    return patterns


def place_of(key, depth, shift):
    return sum((key >> 3 * i + shift & 1) << i for i in range(depth))


def coordinate(place, depth):
    """The f16 pattern of a place."""
    if depth == 16:
        return place - 0x8000 if place >= 0x8000 else 0xFFFF - place
    return struct.unpack("<H", struct.pack("<e", place / 2.0 ** (depth - 1) - 1))[0]
