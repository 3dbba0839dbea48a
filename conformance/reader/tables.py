# SPDX-License-Identifier: BSD-2-Clause
"""The tables of annex A, computed from their formulas.

Every entry is exact or the rounding of an irrational number, so it is computed with 30 decimal
digits and rounded once: it could be wrong only if 20 digits agreed with a tie. test_tables.py
compares each entry with the printed annex.
"""

from decimal import Decimal, ROUND_CEILING, ROUND_HALF_EVEN, localcontext

DIGITS = 30


def rne(v):
    """4.3: nearest integer, ties to even."""
    return int(v.to_integral_value(ROUND_HALF_EVEN))


def power_table(first, count, per_octave):
    """2^((i - first) / per_octave), i = 0 .. count - 1, for a power of two per_octave; exact at
    whole octaves."""
    root, n = Decimal(2), per_octave
    while n > 1:
        root, n = root.sqrt(), n // 2
    within = [root ** j for j in range(per_octave)]
    return [Decimal(2) ** ((i - first) // per_octave) * within[(i - first) % per_octave]
            for i in range(count)]


def phi(x):
    """Phi(x), the normal distribution function, by the series of (Phi(x) - 1/2) / density(x)."""
    term, total, n = x, x, 1
    while abs(term) > Decimal(10) ** -DIGITS:
        n += 2
        term = term * x * x / n
        total += term
    return Decimal("0.5") + total * (-x * x / 2).exp() / (2 * pi()).sqrt()


def pi():
    """Machin: pi = 16 atan(1/5) - 4 atan(1/239)."""
    def atan_inverse(n):
        power, total, k = Decimal(1) / n, Decimal(0), 0
        while power > Decimal(10) ** -DIGITS:
            total += (-power if k % 2 else power) / (2 * k + 1)
            power, k = power / (n * n), k + 1
        return total
    return 16 * atan_inverse(5) - 4 * atan_inverse(239)


def sine_table():
    """sin(2 pi i / 1024), i = 0 .. 1024: the first quarter by its series, the rest by symmetry."""
    turn = 2 * pi() / 1024

    def sine(i):
        x = turn * i
        term, total, n = x, x, 1
        while abs(term) > Decimal(10) ** -DIGITS:
            n += 2
            term = -term * x * x / (n * (n - 1))
            total += term
        return total
    quarter = [sine(i) for i in range(257)]
    half = quarter + quarter[255::-1]
    return half + [-v for v in half[1:]]


with localcontext() as context:
    context.prec = DIGITS + 10
    SIGMA = power_table(64, 240, 16)
    HALF = [min(max(int((6 * s).to_integral_value(ROUND_CEILING)), 2), 4095) for s in SIGMA]
    INV = [rne(2 ** 17 / s) for s in SIGMA]
    below = [rne(2 ** 24 * phi(Decimal(i - 512) / 64)) for i in range(1, 512)]
    PHI = [0] + below + [2 ** 23] + [2 ** 24 - p for p in reversed(below)] + [2 ** 24]
    SIN = [rne(4096 * s) for s in sine_table()]
    steps = power_table(128, 256, 32)
    STEPI = [rne(4096 * s) for s in steps]
    # A binary32 significand has 24 bits; exponents lie between -4 and 3, where nothing is
    # subnormal.
    STEP = [rne(s * 2 ** (23 - (i - 128) // 32)) / 2.0 ** (23 - (i - 128) // 32)
            for i, s in enumerate(steps)]
