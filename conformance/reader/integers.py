# SPDX-License-Identifier: BSD-2-Clause
"""Integer operations of 4.3 (R-CNV-002). Python's >> is floor division by a power of two for
negative numbers too."""


def round_shift(x, r):
    return x + (1 << r >> 1) >> r


def sat16(x):
    return -32767 if x < -32767 else 32767 if x > 32767 else x


def clamp(x, low, high):
    return low if x < low else high if x > high else x
