# SPDX-License-Identifier: BSD-2-Clause
"""Substreams and their coder (9.2). Rules are judged in the order of R-ENT-012."""

import struct

from verdict import Refusal, require

TOTAL = 1 << 16


def lane_count(n):
    """R-ENT-009: the largest power of two not above n / 4096, at least 1 and at most 64; 0 when
    nothing is coded."""
    if n == 0:
        return 0
    return min(64, 1 << max(0, (n >> 12).bit_length() - 1))


class Substream:
    """The coder of one substream of n symbols; all its errors are reported at its first byte
    (chapter 14).

    slot(i) returns the slot to which the state of symbol i's lane (R-ENT-010) points; advance(i,
    first, freq) consumes the symbol there.
    """

    def __init__(self, data, start, size, n):
        self.start, self.n, self.lanes = start, n, lane_count(n)
        # R-ENT-009
        require(size == 0 if n == 0 else size >= 4 * self.lanes and size % 2 == 0,
                "ent.size", start)
        self.states = list(struct.unpack_from("<%dI" % self.lanes, data, start))
        require(all(x >= TOTAL for x in self.states), "ent.state", start)               # R-ENT-004
        self.words = struct.unpack_from("<%dH" % (size // 2 - 2 * self.lanes), data,
                                        start + 4 * self.lanes)
        self.next = 0

    def slot(self, i):
        return self.states[i % self.lanes] & 0xFFFF

    def advance(self, i, first, freq):
        lane = i % self.lanes
        x = self.states[lane]
        x = freq * (x >> 16) + (x & 0xFFFF) - first
        if x < TOTAL:
            if self.next == len(self.words):
                raise Refusal("ent.underrun", self.start)                               # R-ENT-011
            x = x << 16 | self.words[self.next]
            self.next += 1
        self.states[lane] = x

    def bit(self, i, ones):
        """A bit that is 1 in slots [0, ones)."""
        if self.slot(i) < ones:
            self.advance(i, 0, ones)
            return 1
        self.advance(i, ones, TOTAL - ones)
        return 0

    def finish(self):
        """R-ENT-005."""
        ended = all(x == TOTAL for x in self.states) and self.next == len(self.words)
        require(ended, "ent.final", self.start)
