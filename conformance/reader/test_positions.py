# SPDX-License-Identifier: BSD-2-Clause
"""POSN: each rule of chapter 8 at its bounds, and the order of judgement (R-POS-003)."""

import struct
import unittest

from elements import Payload
from positions import Positions, image, morton
from verdict import Refusal

ONE, ABOVE, MINUS_ZERO, INFINITE, SMALLEST = 0x3C00, 0x3C01, 0x8000, 0x7C00, 0x0001


def read(*anchors):
    payload = struct.pack("<%dH" % (3 * len(anchors)), *(p for anchor in anchors for p in anchor))
    try:
        return Positions(Payload(payload, 0, len(payload)), len(anchors)).fixed
    except Refusal as refusal:
        return refusal.error, refusal.offset


class Rules(unittest.TestCase):
    def test_values(self):
        self.assertEqual([-1 << 24, 1, 1 << 24], read((ONE | 0x8000, SMALLEST, ONE)))
        self.assertEqual(("pos.value", 2), read((0, MINUS_ZERO, 0)))
        self.assertEqual(("pos.value", 4), read((0, 0, INFINITE)))
        self.assertEqual(("pos.range", 0), read((ABOVE, 0, 0)))
        self.assertEqual(("pos.range", 0), read((ABOVE | 0x8000, INFINITE, 0)))

    def test_order(self):
        self.assertEqual(6, len(read((0, 0, 0), (0, 0, 1))))
        self.assertEqual(("pos.order", 6), read((0, 0, 0), (0, 0, 0)))
        self.assertEqual(("pos.order", 6), read((0, 0, 1), (0, 0, 0)))
        # order is not judged
        self.assertEqual(("pos.value", 10), read((0, 0, 1), (0, 0, MINUS_ZERO)))
        self.assertEqual(("pos.order", 6), read((0, 0, 1), (0, 0, 0), (0, 0, MINUS_ZERO)))

    def test_image_keeps_the_order_of_numbers(self):
        patterns = [0xBC00, 0x8001, 0, 1, 0x3C00]
        self.assertEqual(sorted(map(image, patterns)), list(map(image, patterns)))

    def test_code(self):
        """x holds the highest bits; a bit of z is lower than the same bit of y."""
        base = morton((0, 0, 0))
        self.assertEqual([1, 2, 4, 8, 1 << 27], [morton(p) - base
                                                 for p in ((0, 0, 1), (0, 1, 0), (1, 0, 0),
                                                           (0, 0, 2), (0, 0, 512))])


if __name__ == "__main__":
    unittest.main()
