# SPDX-License-Identifier: BSD-2-Clause
"""Networks of Tier E: packed layers against plain loops, and the rules of 7.2 and 7.3 at their
bounds."""

import random
import struct
import unittest
import zlib
from types import SimpleNamespace

from blob import Blob
from elements import Payload
from integer_networks import Layer, read_networks
from integers import clamp, round_shift, sat16
from verdict import Refusal

HEADER = dict(prior=1, pe_octaves=0, hyper_width=0, hyper_layers=0, types=[("feature", 2)],
              slice=[1, 1], n_slices=2, ar_width=1, context_bits=10)


def plain(weights, biases, shifts, hidden, x):
    """7.3 as it is written."""
    out = []
    for row, b, r in zip(weights, biases, shifts):
        y = round_shift(b + sum(w * v for w, v in zip(row, x)), r)
        out.append(max(0, sat16(y)) if hidden else clamp(y, -(2 ** 26 - 1), 2 ** 26 - 1))
    return out


class Packed(unittest.TestCase):
    def test_extreme_sums(self):
        """Sums at both ends of what R-NET-006 allows, side by side."""
        rng = random.Random(4)
        for hidden in (False, True):
            for r in (0, 1, 4, 12, 24):
                half = 1 << r >> 1
                w = (0x7FFFFFFF - half) // (2 * 32767)
                rows = [[s * w, t * w] for s in (-1, 1) for t in (-1, 1)] + [[0, 0], [1, -1]]
                biases = [sign * (0x7FFFFFFF - half - 2 * w * 32767)
                          for sign in (-1, 1, -1, 1, 1, 1)]
                layer = Layer(rows, biases, [r] * 6, hidden)
                for x in ([32767, 32767], [-32767, 32767], [0, 0],
                          [rng.randint(-32767, 32767), rng.randint(-32767, 32767)]):
                    self.assertEqual(plain(rows, biases, [r] * 6, hidden, x), layer(x))

    def test_no_inputs(self):
        self.assertEqual([3, -2], Layer([[], []], [11, -10], [2, 2], False)([]))


def nete(shifts, values, header=HEADER):
    payload = bytes(shifts) + b"\0" + struct.pack("<%df" % len(values), *values)
    return read_networks(Payload(payload, 0, len(payload)), SimpleNamespace(**header))


class Rules(unittest.TestCase):
    """The header has a factorised prior of five outputs and one slice network 1 - 1 - 2: eight
    units, 5 + 2 + 4 values."""

    SHIFTS = [0] * 5 + [10, 0, 0]
    VALUES = [0.0] * 11
    FIRST = 9                                           # offset of the first value

    def refused(self, position=None, value=None, shifts=None):
        values = list(self.VALUES)
        if position is not None:
            values[position] = value
        try:
            nete(shifts or self.SHIFTS, values)
        except Refusal as refusal:
            at = refusal.offset
            return refusal.error, (at - self.FIRST) / 4 if at >= self.FIRST else at
        return None

    def test_zero_networks(self):
        self.assertIsNone(self.refused())

    def test_shifts(self):
        self.assertEqual(("net.shift", 0), self.refused(shifts=[21] + self.SHIFTS[1:]))
        self.assertIsNone(self.refused(shifts=[20] * 8))
        header = dict(HEADER, context_bits=0)  # f = 0, g = 10: the hidden unit needs s >= 10
        self.assertIsNotNone(nete(self.SHIFTS, self.VALUES, header))
        with self.assertRaises(Refusal) as caught:
            nete([0] * 5 + [9, 0, 0], self.VALUES, header)
        self.assertEqual(("net.shift", 5), (caught.exception.error, caught.exception.offset))

    def test_missing_shifts(self):
        """14.1: the first entry that does not fit, after those before it."""
        for payload, expected in ((b"\0\0", ("con.payload-size", 2)), (b"\0\25", ("net.shift", 1))):
            with self.assertRaises(Refusal) as caught:
                read_networks(Payload(payload, 0, len(payload)), SimpleNamespace(**HEADER))
            self.assertEqual(expected, (caught.exception.error, caught.exception.offset))

    def test_weights_round_to_even_and_have_16_bits(self):
        self.assertEqual(("net.weight-range", 5), self.refused(5, 32.0))  # 32 * 2^10 = 32768
        # a tie, to the even 32768
        self.assertEqual(("net.weight-range", 5), self.refused(5, 32767.5 / 1024))
        self.assertIsNone(self.refused(5, 32767.0 / 1024))
        self.assertIsNone(self.refused(5, 32766.5 / 1024))

    def test_accumulator(self):
        """The prior's output 0: s = 0, f = 12, r = 4, so |B| + 8 <= 2^31 - 1. B is a multiple of
        2^8 for an f32 near 2^19."""
        self.assertIsNone(self.refused(0, 524288.0 - 2.0 ** -5))
        self.assertEqual(("net.accumulator", 0), self.refused(0, 524288.0))

    def test_values(self):
        for pattern in (0x80000000, 0x00000001, 0x7F800000, 0x7FC00000):
            value = struct.unpack("<f", struct.pack("<I", pattern))[0]
            self.assertEqual(("net.value", 3), self.refused(3, value))


class Blobs(unittest.TestCase):
    def blob(self, content, count=40):
        payload = Payload(content, 0, len(content))
        try:
            blob = Blob(payload, "netr", count)
            payload.finish()
            return blob.patterns
        except Refusal as refusal:
            return refusal.error, refusal.offset

    def test_deflated(self):
        values = list(range(40))
        planes = bytes(values) + bytes(120)
        stream = zlib.compress(planes)
        self.assertEqual(values, self.blob(b"\1" + stream))
        for wrong in (stream + b"\0", stream[:-1], stream[:-1] + bytes([stream[-1] ^ 1]),
                      zlib.compress(planes[:-1]), zlib.compress(planes + b"\0"),
                      zlib.compress(planes, 0), b""):
            self.assertEqual(("net.deflate", 1), self.blob(b"\1" + wrong))

    def test_preset_dictionary(self):
        coder = zlib.compressobj(zdict=bytes(100))
        self.assertEqual(("net.deflate", 1),
                         self.blob(b"\1" + coder.compress(bytes(160)) + coder.flush()))

    def test_raw_sizes_and_modes(self):
        self.assertEqual([0] * 40, self.blob(bytes(161)))
        self.assertEqual(("con.payload-size", 1), self.blob(bytes(160)))
        self.assertEqual(("con.payload-size", 161), self.blob(bytes(162)))
        self.assertEqual(("con.payload-size", 0), self.blob(b""))
        self.assertEqual(("net.mode", 0), self.blob(b"\2" + bytes(160)))


if __name__ == "__main__":
    unittest.main()
