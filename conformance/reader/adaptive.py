# SPDX-License-Identifier: BSD-2-Clause
"""Substreams of adaptive bits (9.5), and what profile Compact codes with them: the tree of
positions (8.2) and the integers of blobs of mode 2 (7.6, 9.6)."""

from rans import Substream
from verdict import require


class Adaptive:
    """A context: the probability of a 1, in units of 2^-16, and the bits seen so far."""

    __slots__ = ("p", "seen")

    def __init__(self):
        self.p, self.seen = 1 << 15, 0

    def learn(self, bit):
        part = (1 << 16) // (2 * self.seen + 3)
        step = ((65535 if bit else 0) - self.p) * part >> 15
        self.p = min(max(self.p + step, 32), 65504)
        self.seen = min(self.seen + 1, 24)


class Contexts(dict):
    """Contexts by name, created when first needed."""

    def __missing__(self, name):
        self[name] = Adaptive()
        return self[name]


class Rest:
    """The substream `name` that is the rest of a payload and holds n anchors or values."""

    def __init__(self, payload, name, n):
        self.start = payload.at
        size = payload.end - payload.at
        require(8 * size >= n, "ent.size", self.start)                                  # R-ENT-016
        self.substream = Substream(payload.data, self.start, size, 1)
        payload.bytes(name, size)

    def even(self):
        """A bit with p = 2^15."""
        return self.substream.bit(0, 1 << 15)

    def bit(self, context):
        bit = self.substream.bit(0, context.p)
        context.learn(bit)
        return bit

    def finish(self):
        self.substream.finish()


def decode_tree(rest, depth, n):
    """The keys of the leaves in their order; R-POS-005."""
    contexts, keys = Contexts(), []

    def node(prefix, below, family):
        children = 0
        for i in range(8):
            if i == 7 and children == 0:
                children = 128
            else:
                children |= rest.bit(contexts[family, 1 << i | children]) << i
        mine = min(bin(children).count("1") - 1, 2)
        for i in range(8):
            if children >> i & 1:
                if below > 1:
                    node(8 * prefix + i, below - 1, mine)
                else:
                    require(len(keys) < n, "pos.count", rest.start)
                    keys.append(8 * prefix + i)

    node(0, depth, 0)
    require(len(keys) == n, "pos.count", rest.start)
    return keys


def decode_integer(rest, contexts, expected):
    """9.6."""
    node = 1
    for _ in range(5):
        node = 2 * node + rest.bit(contexts["length", expected, node])
    length = node - 32
    if length == 0:
        return 0
    negative = rest.bit(contexts["sign"])
    size = 1
    for i in range(1, length):
        size = 2 * size + (rest.bit(contexts["top", length]) if i == 1 else rest.even())
    return -size if negative else size


def decode_unit(rest, contexts, exponent, n):
    """The f32 patterns of n values; infinity for a value that breaks R-NET-012."""
    lengths, patterns = [0, 0], []
    for _ in range(n):
        k = decode_integer(rest, contexts, (lengths[-2] + lengths[-1] + 1) // 2)
        lengths.append(abs(k).bit_length())
        patterns.append(pattern_of(k, exponent))
    return patterns


def pattern_of(k, exponent):
    size = abs(k)
    biased = size.bit_length() - 1 + exponent + 127
    if k == 0:
        return 0
    if (size & -size) << 24 <= size or not 1 <= biased <= 254:
        return 0x7F800000
    fraction = (size << 24 >> size.bit_length()) & 0x7FFFFF
    return (0x80000000 if k < 0 else 0) | biased << 23 | fraction
