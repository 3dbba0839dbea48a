# SPDX-License-Identifier: BSD-2-Clause
"""Substreams: the coder, masks, Gaussian symbols, escapes, and each error that they can have
(chapter 9)."""

import random
import struct
import unittest
from types import SimpleNamespace

from gaussian import LISTED, MODELS, Cumulative, decode_symbols, escape
from masks import decode_masks
from rans import Substream, lane_count
from sample import DrawnSubstream
from tables import HALF
from verdict import Refusal


class Chosen(DrawnSubstream):
    """Returns the slots that it is given."""

    def __init__(self, slots):
        super().__init__(random.Random(0), 1)
        self.slots = iter(slots)

    def slot(self, i):
        if self.pending is None:
            self.pending = next(self.slots)
        return self.pending


def drawn(n, g, mu, seed=0):
    """Symbols of a random substream and its bytes."""
    substream = DrawnSubstream(random.Random(seed), n)
    symbols = decode_symbols(substream, [g] * n, [mu] * n)
    return symbols, substream.bytes


def refused(data, n, g=64, mu=0):
    with_padding = b"\0" * 5 + data
    try:
        decode_symbols(Substream(with_padding, 5, len(data), n), [g] * n, [mu] * n)
    except Refusal as refusal:
        return refusal.error, refusal.offset
    return "valid"


class Coder(unittest.TestCase):
    def test_lane_count(self):
        self.assertEqual([0, 1, 1, 1, 2, 2, 4, 64, 64],
                         [lane_count(n)
                          for n in (0, 1, 4096, 8191, 8192, 16383, 16384, 262144, 1 << 30)])

    def test_round_trip_for_every_sigma(self):
        for g in range(0, 240, 7):
            mu = 256 * (g - 100) + g
            symbols, data = drawn(150, g, mu, g)
            self.assertEqual(
                symbols, decode_symbols(Substream(data, 0, len(data), 150), [g] * 150, [mu] * 150))

    def test_round_trip_of_lanes(self):
        symbols, data = drawn(20000, 90, -77)
        substream = Substream(data, 0, len(data), 20000)
        self.assertEqual(symbols, decode_symbols(substream, [90] * 20000, [-77] * 20000))
        self.assertEqual([65536] * 4, substream.states)

    def test_each_way_to_be_wrong(self):
        _, data = drawn(100, 100, 0)
        self.assertEqual("valid", refused(data, 100, 100))
        self.assertEqual(("ent.underrun", 5), refused(data[:-2], 100, 100))
        self.assertEqual(("ent.final", 5), refused(data + b"\0\0", 100, 100))
        self.assertEqual(("ent.size", 5), refused(data + b"\0", 100, 100))
        self.assertEqual(("ent.size", 5), refused(b"", 1))
        self.assertEqual(("ent.size", 5), refused(b"\0\0", 0))
        self.assertEqual(("ent.state", 5), refused(struct.pack("<I", 65535), 1))
        self.assertEqual("valid", refused(b"", 0))

    def test_end_of_state_and_of_words(self):
        """Each half of R-ENT-005 by itself."""
        _, data = drawn(1, 64, 0)
        self.assertEqual("valid", refused(data, 1))
        state = struct.unpack("<I", data[:4])[0]
        self.assertEqual("ent.final", refused(struct.pack("<I", state + 1) + data[4:], 1)[0])
        self.assertEqual("ent.final", refused(data + b"\1\0", 1)[0])


class Symbols(unittest.TestCase):
    def take(self, slots, g=64, mu=0):
        return decode_symbols(Chosen(slots), [g], [mu])[0]

    def test_escapes(self):
        half, zero, one = HALF[64], 0, 32768
        self.assertEqual(-half - 1, self.take([0, zero]))
        self.assertEqual(half + 2, self.take([65535, zero]))
        self.assertEqual(half + 2 + 5, self.take([65535, one, one, zero, one, zero]))  # E = 6 = 110

    def test_longest_escape(self):
        e = escape(Chosen([32768] * 19 + [0] + [32768] * 19), 0)
        self.assertEqual((1 << 20) - 2, e)
        with self.assertRaises(Refusal) as caught:
            escape(Chosen([32768] * 20), 0)
        self.assertEqual("ent.escape", caught.exception.error)

    def test_range(self):
        """k = 32767 and -32767 are reached, one more is refused."""
        centre = Cumulative(64, 0)[HALF[64] + 1]            # r = 0
        self.assertEqual(32767, self.take([centre], mu=32767 << 8))
        self.assertEqual(-32767, self.take([centre], mu=-32767 * 256))
        for mu in (32768 << 8, -32768 * 256):
            with self.assertRaises(Refusal) as caught:
                self.take([centre], mu=mu)
            self.assertEqual("ent.symbol-range", caught.exception.error)

    def test_lists_and_searches_agree(self):
        for g in range(240):
            if HALF[g] <= LISTED:
                self.assertEqual([Cumulative(g, 9)[j] for j in range(2 * HALF[g] + 5)],
                                 MODELS.get(g, 9))


class Masks(unittest.TestCase):
    def contexts(self, slots, probabilities):
        h = SimpleNamespace(temporal_mask=1, offset_mask=1, n_offsets=4, moves=True)
        return decode_masks(Chosen(slots), h, 1, 30000, probabilities)[:2]

    def test_contexts(self):
        """Dynamic bit 1, then contexts 3 + (1, 1, 2, 2); dynamic bit 0, then contexts 1, 0, 0,
        2."""
        self.assertEqual(([1], [0b1101]),
                         self.contexts([29999, 40, 50, 59, 59], [0, 0, 0, 1, 50, 60]))
        self.assertEqual(([0], [0b1100]),
                         self.contexts([30000, 20, 10, 9, 29], [10, 20, 30, 0, 0, 0]))


if __name__ == "__main__":
    unittest.main()
