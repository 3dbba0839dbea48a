# SPDX-License-Identifier: BSD-2-Clause
"""Syntax elements: where each lies in the file (chapters 5 to 9.1) and its identifier in T0
(J.2)."""

import struct

from verdict import require

IDENTIFIER = {}


def number_names(first, names):
    for i, name in enumerate(names.split()):
        IDENTIFIER[name] = first + i


number_names(1, "magic major minor profile level")
number_names(16, "chunk_type chunk_flags chunk_size ancillary chunk_hash")
number_names(32, "n_anchors tile_size n_offsets feature_dim motion phi_dim bank_rows bank_dim "
                 "deform_layers deform_width temporal_mask offset_mask activation view head_layers "
                 "head_width scale_domain prior pe_octaves hyper_layers hyper_width n_slices slice "
                 "ar_width context_bits step frames rate_num rate_den origin exponent background "
                 "reserved")
number_names(96, "shift mode nete nete_deflated netr netr_deflated bank bank_deflated "
                 "unit_exponent weights_substream")
number_names(112, "position grid tree_substream")
number_names(128, "tile_index dynamic_prob offset_prob size mask_substream feature_substream "
                  "scaling_substream offset_substream phi_substream tau_substream")
number_names(160, "ends_hash")


class Payload:
    """The elements of one chunk's payload, taken in order; `spans` keeps what was taken, for T0.

    A span is (name, width, count, offset): count numbers of width bytes, or, with width 0, count
    bytes as one element. `compact`: the profile.
    """

    def __init__(self, data, start, end, compact=False):
        self.data, self.at, self.end, self.compact = data, start, end, compact
        self.spans = []

    def number(self, name, width):
        start = self.at
        self.take(name, width, 1, width)
        return int.from_bytes(self.data[start:self.at], "little")

    def entries(self, name, width, count):
        """An array of unsigned numbers, yielded one by one as (offset, number), so that those
        before a missing one can be judged first (14.1)."""
        for _ in range(count):
            yield self.at, self.number(name, width)

    def numbers(self, name, width, count):
        """An array of u16 or u32 that 14.1 judges as a whole."""
        start = self.at
        self.take(name, width, count, width * count)
        return list(struct.unpack_from("<%d%s" % (count, {2: "H", 4: "I"}[width]),
                                       self.data, start))

    def bytes(self, name, size):
        """An element that is shown as bytes."""
        start = self.at
        self.take(name, 0, size, size)
        return self.data[start:self.at]

    def take(self, name, width, count, size):
        require(size <= self.end - self.at, "con.payload-size", self.at)
        self.spans.append((name, width, count, self.at))
        self.at += size

    def finish(self):
        """R-CON-011: bytes left over are con.payload-size at the first of them, so this comes after
        everything in the payload has been judged."""
        require(self.at == self.end, "con.payload-size", self.at)

