# SPDX-License-Identifier: BSD-2-Clause
"""HEAD: every element at the ends of its range, every condition, every level bound (chapters 6 and
13)."""

import unittest

from elements import Payload
from header import ARRAYS, ELEMENTS, FLOATS, read_header
from levels import LEVELS, check_totals
from limits import check_memory, check_work
from sample import f32, head_payload
from verdict import Refusal

# Motion by a bank, every switch on, the inr prior; two slices.
MOVING = {
    "n_anchors": 100, "tile_size": 64, "n_offsets": 2, "feature_dim": 4, "motion": 1, "phi_dim": 2,
    "bank_rows": 3, "bank_dim": 2, "deform_layers": 1,
    "deform_width": 3, "temporal_mask": 1, "offset_mask": 1, "activation": 1, "view": 1,
    "head_layers": 1, "head_width": 4, "scale_domain": 0, "prior": 0,
    "pe_octaves": 2, "hyper_layers": 1, "hyper_width": 5, "n_slices": 2, "slice": [1, 3],
    "ar_width": 4, "context_bits": 10,
    "step": [f32(1.0)] * 5, "frames": 9, "rate_num": 30, "rate_den": 1, "origin": [0, 0, 0],
    "exponent": 255, "background": [0, 0, 0], "reserved": 0}
# Nothing moves, a factorised prior, one slice, heads of one layer.
STILL = dict(MOVING, motion=0, phi_dim=0, bank_rows=0, bank_dim=0, deform_layers=0, deform_width=0,
             temporal_mask=0, head_layers=0, head_width=0, prior=1,
             pe_octaves=0, hyper_layers=0, hyper_width=0, n_slices=1, slice=[4], ar_width=0)


def judged(base, level=31, file_bytes=1 << 20, **changes):
    """None, or the identifier, and the name of the element whose offset is reported, with the
    number of its entry."""
    elements = dict(base, **changes)
    payload = head_payload(elements)
    try:
        read_header(Payload(payload, 0, len(payload)), level, file_bytes)
    except Refusal as refusal:
        return refusal.error, element_at(elements, refusal.offset)
    return None


def element_at(elements, offset):
    at = 0
    for name, width, _, _, _ in ELEMENTS:
        size = width * (len(elements[name]) if name in ARRAYS else 1)
        if offset < at + size:
            return name + (" %d" % ((offset - at) // width) if name in ARRAYS else "")
        at += size
    return "behind"


class Elements(unittest.TestCase):
    def test_bases(self):
        self.assertIsNone(judged(MOVING))
        self.assertIsNone(judged(STILL))

    def test_ranges(self):
        for name, width, _, low, high in ELEMENTS:
            if name in ARRAYS or name == "exponent":
                continue
            for wrong in (low - 1, high + 1):
                if 0 <= wrong < 256 ** width:
                    self.assertEqual(("hdr.range", name), judged(MOVING, **{name: wrong}))
        for wrong in (31, 0x80, 256 - 31):
            self.assertEqual(("hdr.range", "exponent"), judged(MOVING, exponent=wrong))
        for right in (30, 256 - 30):
            self.assertIsNone(judged(MOVING, exponent=right))
        self.assertEqual(("hdr.range", "slice 1"), judged(MOVING, slice=[4, 0]))
        self.assertEqual(("hdr.range", "slice 0"), judged(MOVING, slice=[129, 0]))

    def test_floats(self):
        for name in FLOATS:
            entries = MOVING[name]
            for wrong in (0x80000000, 0x00000001, 0x7F800000, 0xFF800000, 0x7FC00000):
                self.assertEqual(("hdr.range", name + " 2"),
                                 judged(MOVING, **{name: entries[:2] + [wrong] + entries[3:]}))
        for step, right in ((f32(2.0 ** -20), True), (f32(2.0 ** -20) - 1, False),
                            (f32(2.0 ** 10), True), (f32(2.0 ** 10) + 1, False), (0, False)):
            expected = None if right else ("hdr.range", "step 4")
            self.assertEqual(expected, judged(MOVING, step=MOVING["step"][:4] + [step]))

    def test_conditions(self):
        """What is there must not be 0; what is not must be."""
        for name in ("phi_dim", "bank_rows", "bank_dim", "deform_layers", "deform_width",
                     "head_width", "hyper_width", "ar_width"):
            self.assertEqual(("hdr.combination", name), judged(MOVING, **{name: 0}))
            self.assertEqual(("hdr.combination", name), judged(STILL, **{name: 1}))
        for name in ("temporal_mask", "pe_octaves", "hyper_layers"):
            self.assertEqual(("hdr.combination", name), judged(STILL, **{name: 1}))
            self.assertNotEqual(("hdr.combination", name), judged(MOVING, **{name: 0}))
        self.assertEqual(("hdr.combination", "phi_dim"), judged(MOVING, motion=3))
        self.assertIsNone(judged(MOVING, motion=3, phi_dim=0, bank_rows=0, bank_dim=0))
        self.assertEqual(("hdr.combination", "slice 1"), judged(MOVING, slice=[1, 2]))

    def test_size(self):
        payload = head_payload(MOVING)
        # Missing: the last element; a byte of the second entry of background; the first element.
        for cut, at in ((1, len(payload) - 1), (3, len(payload) - 3), (len(payload), 0)):
            with self.assertRaises(Refusal) as caught:
                read_header(Payload(payload, 0, len(payload) - cut), 31, 1 << 20)
            self.assertEqual(("con.payload-size", at),
                             (caught.exception.error, caught.exception.offset))


class Memory(unittest.TestCase):
    def setUp(self):
        payload = head_payload(MOVING)
        self.h = read_header(Payload(payload, 0, len(payload)), 31, 1 << 20)

    def refused(self, file_bytes, bound):
        with self.assertRaises(Refusal) as caught:
            check_memory(self.h, file_bytes, bound)
        self.assertEqual("limit.memory", caught.exception.error)

    def test_bound(self):
        """M_E of 13.3 by hand, one tile of 64: V = 643, P = 49, C = 22, F = 4, 100 anchors."""
        need = (1 << 20) + 777 + 16 * 643 + 100 * (44 + 16) + 64 * (196 + 8 + 11) + (1 << 17)
        check_memory(self.h, 777, need)
        self.refused(777, need - 1)

    def test_what_counts(self):
        """Without a bound: symbols of the anchors that the file can hold, values, and its bytes."""
        check_memory(self.h, 1000000, None)
        self.refused(1 << 28, None)
        self.h.n_anchors = self.h.bank_rows = 1 << 31
        check_memory(self.h, 600, None)
        self.refused(1 << 20, None)


class Work(unittest.TestCase):
    def test_bound(self):
        """W_E of 13.4 by hand: V = 643, A_E = 348, P = 49, C = 22, K = 2, 100 anchors."""
        payload = head_payload(MOVING)
        h = read_header(Payload(payload, 0, len(payload)), 31, 1 << 20)
        steps = 777 + 4 * 643 + 100 * (348 + 49 + 22 + 2 + 1)
        check_work(h, 777, None)
        check_work(h, 777, steps)
        with self.assertRaises(Refusal) as caught:
            check_work(h, 777, steps - 1)
        self.assertEqual("limit.work", caught.exception.error)


class Level(unittest.TestCase):
    def test_elements(self):
        for level in (1, 2, 3, 4):
            bound = LEVELS[level]
            for name, most in (("n_anchors", bound.anchors), ("frames", bound.frames),
                               ("bank_rows", bound.frames), ("n_offsets", bound.offsets)):
                self.assertIsNone(judged(MOVING, level, 1 << 40, **{name: most}))
                expected = "hdr.range" if most == 16 else "lvl.exceeded"
                self.assertEqual((expected, name),
                                 judged(MOVING, level, 1 << 40, **{name: most + 1}))

    def test_range_then_combination_then_level(self):
        self.assertEqual(("hdr.combination", "bank_rows"), judged(STILL, 1, bank_rows=1 << 20))

    def test_totals(self):
        """Values, products, symbols a byte, each by itself; and that HEAD is where they come
        from."""
        for level in (1, 2, 3, 4):
            bound = LEVELS[level]
            most = [bound.values, bound.products, bound.symbols_per_byte * 1000]
            check_totals(level, *most, 1000, 7)
            for i in range(3):
                with self.assertRaises(Refusal) as caught:
                    check_totals(level, *[n + (i == j) for j, n in enumerate(most)], 1000, 7)
                self.assertEqual(("lvl.exceeded", 7),
                                 (caught.exception.error, caught.exception.offset))
        # 100 anchors with 4 + 6 + 6 + 2 + 4 components: 2200 symbols, 8.6 bytes at 256 per byte.
        self.assertIsNone(judged(MOVING, 1, 9))
        self.assertEqual(("lvl.exceeded", "reserved"), judged(MOVING, 1, 8))
        # Three hidden layers of 181 have 65522 products, inputs and outputs not counted; four of
        # 512 more than level 4 takes.
        self.assertEqual(("lvl.exceeded", "reserved"),
                         judged(MOVING, 1, hyper_layers=3, hyper_width=181))
        self.assertEqual(("lvl.exceeded", "reserved"),
                         judged(MOVING, 4, hyper_layers=4, hyper_width=512))
        self.assertEqual(("lvl.exceeded", "reserved"),
                         judged(MOVING, 1, frames=64, bank_rows=64, bank_dim=512, deform_layers=8,
                                deform_width=512))


if __name__ == "__main__":
    unittest.main()
