# SPDX-License-Identifier: BSD-2-Clause
"""POSN (chapter 8), judged anchor after anchor (R-POS-003)."""

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
        self.values = f16_values(self.patterns)
        self.fixed = [int(v * 16777216.0) for v in self.values]
