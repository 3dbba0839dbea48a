# SPDX-License-Identifier: BSD-2-Clause
"""Binary32 arithmetic against exact rational arithmetic (12.2)."""

import math
import random
import struct
import unittest
from fractions import Fraction

import strict
from floats import f32_values

LARGEST = float.fromhex("0x1.fffffep127")
SMALLEST = 2.0 ** -149


def nearest(exact):
    """The binary32 nearest to a Fraction, ties to even: the definition of IEEE 754, by integers."""
    if exact == 0:
        return 0.0
    magnitude = abs(exact)
    exponent = max(magnitude.numerator.bit_length() - magnitude.denominator.bit_length() - 1, -126)
    if Fraction(2) ** (exponent + 1) <= magnitude:
        exponent += 1
    unit = Fraction(2) ** (exponent - 23)
    value = round(magnitude / unit) * unit          # round() of a Fraction takes ties to even
    value = math.inf if value > LARGEST else float(value)
    return value if exact > 0 else -value


def some(rng):
    """A finite binary32: any exponent, few or many significant bits."""
    pattern = rng.getrandbits(32) & (0xFF800000 | rng.choice((0x7FFFFF, 0x400000, 0x7FF000, 0x7)))
    value = f32_values([pattern])[0]
    return value if math.isfinite(value) else 1.5


class Operations(unittest.TestCase):
    def check(self, operation, exact, a, b):
        expected, got = nearest(exact), operation([a], [b])[0]
        self.assertEqual(expected, got, (operation.__name__, a.hex(), b.hex()))

    def test_random_operands(self):
        rng = random.Random(2)
        for _ in range(4000):
            a, b = some(rng), some(rng)
            if rng.random() < 0.5:              # close exponents, where sums cancel and round
                b = nearest(Fraction(a) * Fraction(rng.uniform(-8, 8)))
                b = b if math.isfinite(b) else 1.0
            x, y = Fraction(a), Fraction(b)
            self.check(strict.add, x + y, a, b)
            self.check(strict.sub, x - y, a, b)
            self.check(strict.mul, x * y, a, b)
            if b:
                self.check(strict.div, x / y, a, b)

    def test_square_root(self):
        rng = random.Random(3)
        for _ in range(2000):
            a = abs(some(rng))
            root = strict.sqrt([a])[0]
            self.assertLessEqual(((self.neighbour(root, -1) + Fraction(root)) / 2) ** 2,
                                 Fraction(a))
            self.assertGreaterEqual(((self.neighbour(root, 1) + Fraction(root)) / 2) ** 2,
                                    Fraction(a))

    @staticmethod
    def neighbour(value, step):
        pattern = struct.unpack("<I", struct.pack("<f", value))[0] + step
        return Fraction(f32_values([max(pattern, 0)])[0])

    def test_edges(self):
        self.assertEqual([math.inf], strict.add([LARGEST], [LARGEST]))
        self.assertEqual([math.inf], strict.scaled([LARGEST], 2.0))
        self.assertEqual([SMALLEST], strict.scaled([SMALLEST], 1.0))
        self.assertEqual([0.0], strict.scaled([SMALLEST], 0.5))  # a tie, to even
        self.assertEqual([2 * SMALLEST], strict.scaled([3 * SMALLEST], 0.5))  # a tie, to even
        self.assertTrue(math.isnan(strict.sub([math.inf], [math.inf])[0]))
        self.assertEqual("-0x0.0p+0", strict.relu([-0.0])[0].hex())
        self.assertTrue(math.isnan(strict.relu([math.nan])[0]))


class Functions(unittest.TestCase):
    def test_pow2_is_exact_at_integers(self):
        x = [float(n) for n in range(-126, 127)]
        self.assertEqual([2.0 ** n for n in range(-126, 127)], strict.pow2(x))

    def test_pow2_is_close_and_clamped(self):
        x = [i / 37 for i in range(-4000, 4000)]
        for v, y in zip(strict.rounded(x), strict.pow2(strict.rounded(x))):
            self.assertAlmostEqual(1.0, y / 2.0 ** v, delta=2e-6)
        self.assertEqual([2.0 ** 126, 2.0 ** -126], strict.pow2([1e30, -math.inf]))
        self.assertTrue(math.isnan(strict.pow2([math.nan])[0]))

    def test_sigmoid(self):
        self.assertEqual([0.5, 1.0], strict.sigmoid([0.0, 200.0]))

    def test_dense(self):
        """Two anchors, two inputs, a hidden unit that is cut and one that is not, one output."""
        hidden = ([[1.0, 2.0], [-1.0, 0.0]], [0.5, 0.0])
        output = ([[1.0, 10.0]], [-1.0])
        self.assertEqual([[4.5, 9.0]], strict.dense([hidden, output], [[1.0, -1.0], [2.0, 0.0]]))


if __name__ == "__main__":
    unittest.main()
