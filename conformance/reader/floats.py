# SPDX-License-Identifier: BSD-2-Clause
"""Bit patterns of binary16 and binary32, and their values (4.2)."""

import struct


def f32_sound(pattern):
    """R-CNV-001 for an f32: finite, not subnormal, not negative zero."""
    exponent = pattern & 0x7F800000
    return exponent != 0x7F800000 and (exponent != 0 or pattern == 0)


def f16_sound(pattern):
    """R-CNV-001 for an f16: finite, not negative zero."""
    return pattern & 0x7C00 != 0x7C00 and pattern != 0x8000


def f32_values(patterns):
    """Patterns to numbers. A binary64, which Python's float is, holds every finite binary32
    exactly."""
    return struct.unpack("<%df" % len(patterns), struct.pack("<%dI" % len(patterns), *patterns))


def f32_patterns(values):
    """Numbers that are binary32 values already, to patterns."""
    return struct.unpack("<%dI" % len(values), struct.pack("<%df" % len(values), *values))


def f32_round(value):
    """The binary32 nearest to a binary64, ties to even, as packing rounds. The value must not
    overflow."""
    return struct.unpack("<f", struct.pack("<f", value))[0]


def f16_values(patterns):
    return struct.unpack("<%de" % len(patterns), struct.pack("<%dH" % len(patterns), *patterns))
