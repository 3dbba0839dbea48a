# SPDX-License-Identifier: BSD-2-Clause
"""The Gaussian model of a symbol (9.4: R-ENT-015), and symbols of a substream."""

from bisect import bisect_right

from integers import clamp
from tables import HALF, INV, PHI
from verdict import require

# windows of more than twice this are not kept as lists: they would take longer to make than to
# search
LISTED = 64


class Cumulative:
    """cum(0) .. cum(R) for sigma index g and fraction fr of mu, computed on access."""

    def __init__(self, g, fr):
        self.inverse = INV[g]
        self.half = HALF[g]
        self.size = 2 * self.half + 4
        self.first = 256 * (-1 - self.half) - 128 - fr          # d = first + 256 j

    def __len__(self):
        return self.size + 1

    def __getitem__(self, j):
        if not 0 < j < self.size:
            return 65536 if j else 0
        z = clamp((self.first + 256 * j) * self.inverse >> 11, -131072, 131072) + 131072
        i, b = z >> 8, z & 255
        p = PHI[i] + ((PHI[min(i + 1, 1024)] - PHI[i]) * b >> 8)
        return ((p >> 8) * (65536 - self.size) >> 16) + j


class Models:
    """Cumulative tables by (g, fr); short ones as lists, made once."""

    def __init__(self):
        self.lists = {}

    def get(self, g, fr):
        table = self.lists.get(g << 8 | fr)
        if table is None:
            table = Cumulative(g, fr)
            if table.half <= LISTED:
                table = self.lists[g << 8 | fr] = [table[j] for j in range(len(table))]
        return table


MODELS = Models()


def decode_symbols(substream, sigma, mu):
    """The symbols k of a whole substream, given sigma index and mu (Q8) of each in coded order.
    Checks the final state of the coder."""
    symbols = []
    for i, (g, m) in enumerate(zip(sigma, mu)):
        table = MODELS.get(g, m & 255)
        slot = substream.slot(i)
        j = bisect_right(table, slot) - 1
        first = table[j]
        substream.advance(i, first, table[j + 1] - first)
        half = HALF[g]
        r = j - 1 - half
        if j == 0:
            r = -half - 1 - escape(substream, i)
        elif r == half + 2:
            r = half + 2 + escape(substream, i)
        k = (m >> 8) + r
        require(-32767 <= k <= 32767, "ent.symbol-range", substream.start)              # R-ENT-007
        symbols.append(k)
    substream.finish()
    return symbols


def escape(substream, i):
    """e, coded as b bits 1, a bit 0, then the b low bits of e + 1 from the highest. A bit is 0 in
    the low half of the slots."""
    b = 0
    while not substream.bit(i, 32768):          # Substream.bit calls the low half 1
        b += 1
        require(b <= 19, "ent.escape", substream.start)                                 # R-ENT-006
    e = 1
    for _ in range(b):
        e = 2 * e + 1 - substream.bit(i, 32768)
    return e - 1
