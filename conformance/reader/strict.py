# SPDX-License-Identifier: BSD-2-Clause
"""Strict binary32 arithmetic on vectors (12.2).

A vector is a list of Python floats (binary64) whose values are binary32 values. An operation works
in binary64 and rounds its result once more, by storing it in an array of C floats. That is the
binary32 operation, exactly:

* A product of two binary32 values has at most 48 significant bits and an exponent far inside
  binary64's range: it is exact, so there is one rounding.
* A sum, difference, quotient or square root may be rounded twice, which is harmless from 53 to 24
  bits, since 53 >= 2 * 24 + 2 (Figueroa, "When is double rounding innocuous?"): such a result is
  either exact in 53 bits or farther than half a unit of binary64 from every midpoint between two
  binary32 neighbours. Subnormal results have shorter significands and so still more room; subnormal
  sums are exact.
* Results that are too large become infinite, as IEEE 754 says; storing in an array, unlike
  struct.pack, raises no error.
"""

import math
import operator
from array import array
from itertools import repeat

LOG2E = float.fromhex("0x1.715476p+0")
HORNER = [float.fromhex(c) for c in ("0x1.ffcbfcp-17", "0x1.430912p-13", "0x1.5d87fep-10",
                                     "0x1.3b2ab6p-7", "0x1.c6b08ep-5", "0x1.ebfbep-3",
                                     "0x1.62e43p-1", "0x1p+0")]


def rounded(values):
    return array("f", list(values)).tolist()


def add(a, b):
    return rounded(map(operator.add, a, b))


def sub(a, b):
    return rounded(map(operator.sub, a, b))


def mul(a, b):
    return rounded(map(operator.mul, a, b))


def div(a, b):
    """No divisor of chapter 11 can be zero: each is at least 2^-20, or not a number."""
    return rounded(map(operator.truediv, a, b))


def sqrt(a):
    return rounded(map(math.sqrt, a))


def scaled(a, c):
    """Each element times the number c."""
    return rounded(map(operator.mul, a, repeat(c)))


def shifted(a, c):
    """Each element plus the number c."""
    return rounded(map(operator.add, a, repeat(c)))


def negated(a):
    return list(map(operator.neg, a))


def at_least(low, a):
    """max(a, low) for operands in either order: 12.2 distinguishes them only for NaN, which stays,
    and for zeros of different sign (see relu)."""
    return [low if v < low else v for v in a]


def pow2(x):
    """12.2, step by step."""
    x = [v if v != v else -126.0 if v < -126.0 else 126.0 if v > 126.0 else v for v in x]
    n = [v if v != v else float(math.floor(v)) for v in shifted(x, 0.5)]
    f = sub(x, n)
    p = [HORNER[0]] * len(x)
    for c in HORNER[1:]:
        p = shifted(mul(p, f), c)
    return mul(p, [v if v != v else 2.0 ** v for v in n])


def sigmoid(x):
    """11.5: 1 / (1 + pow2(-x LOG2E))."""
    return div(repeat(1.0), shifted(pow2(scaled(negated(x), LOG2E)), 1.0))


def dense(layers, x):
    """A network of dense layers (7.1) on many anchors at once: x holds one vector per input, the
    result one per output.

    For each input in order, one product and one sum of all units on all anchors: unit o on anchor a
    is element o count + a of acc.
    """
    count = len(x[0])
    for number, (weights, biases) in enumerate(layers):
        acc = [bias for bias in biases for _ in range(count)]
        for column, vector in zip(zip(*weights), x):
            acc = add(acc, rounded([w * v for w in column for v in vector]))
        if number < len(layers) - 1:
            acc = relu(acc)
        x = [acc[at:at + count] for at in range(0, len(acc), count)]
    return x


def relu(a):
    """max(0, y): y unless 0 > y, so negative zero stays."""
    return [0.0 if 0.0 > v else v for v in a]
