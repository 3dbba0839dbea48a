# SPDX-License-Identifier: BSD-2-Clause
"""Blobs and positions of random streams of profile Compact (8.2, 7.6): random integers and
positions are turned into the bits of 9.5 and 9.6, and coded with the contexts of the reader."""

import struct

from adaptive import Contexts, decode_tree, decode_unit
from integer_networks import PHASE_BITS, coded_units, plan
from positions import morton
from rans import TOTAL
from shapes import hyperprior_shape, layers, slice_shapes, tier_r_shapes
from verdict import require

DEPTHS = (6, 7, 8, 9, 10, 11, 12, 16)


def code_slots(taken, lanes):
    """9.2 backwards, from the final states to the initial ones: the substream from which (lane,
    first, freq) are taken in that order."""
    states, words = [TOTAL] * lanes, []
    for lane, first, freq in reversed(taken):
        x = states[lane]
        if x >= freq << 16:
            words.append(x & 0xFFFF)
            x >>= 16
        states[lane] = (x // freq << 16) + first + x % freq
    return struct.pack("<%dI%dH" % (lanes, len(words)), *states, *reversed(words))


class GivenRest:
    """Replaces adaptive.Rest: the bits are given, and bytes() codes them."""

    def __init__(self, bits):
        self.bits, self.start, self.taken = iter(bits), 0, []

    def bit(self, context):
        bit = self.even(context.p)
        context.learn(bit)
        return bit

    def even(self, ones=TOTAL // 2):
        bit = next(self.bits)
        self.taken.append((0, 0, ones) if bit else (0, ones, TOTAL - ones))
        return bit

    def bytes(self, n):
        """Of n anchors or values; every bit was taken."""
        assert next(self.bits, None) is None
        substream = code_slots(self.taken, 1)
        require(8 * len(substream) >= n, "ent.size", 0)                                 # R-ENT-016
        return substream


def tree_bits(keys, below):
    """The bits of a node, and of all nodes below it; keys: without the bits of its prefix."""
    children = [[k % 8 ** (below - 1) for k in keys if k >> 3 * (below - 1) == i]
                for i in range(8)]
    for i in range(8):
        if i < 7 or any(children[:7]):
            yield int(bool(children[i]))
    for some in children:
        if some and below > 1:
            yield from tree_bits(some, below - 1)


def integer_bits(k):
    """9.6."""
    length = abs(k).bit_length()
    yield from (length >> i & 1 for i in range(4, -1, -1))
    if k:
        yield int(k < 0)
    yield from (abs(k) >> i & 1 for i in range(length - 2, -1, -1))


def random_places(rng, n):
    """The payload of POSN."""
    depth, keys = rng.choice(DEPTHS), set()
    reach = 1 << rng.choice((3, depth - 1))
    while len(keys) < n:
        if depth == 16:
            keys.add(morton([rng.choice((0, 0x8000)) | rng.randint(1, 0x3C00) for _ in range(3)]))
        else:
            places = [(1 << (depth - 1)) + rng.randrange(-reach, reach) for _ in range(3)]
            keys.add(sum((place >> i & 1) << 3 * i + 2 - j
                         for j, place in enumerate(places) for i in range(depth)))
    rest = GivenRest(tree_bits(sorted(keys), depth))
    decode_tree(rest, depth, n)
    return bytes([depth]) + rest.bytes(n)


def coded(integers, groups):
    """The substream of integers, whose units are those of groups (see blob.Blob)."""
    rest = GivenRest(bit for k in integers for bit in integer_bits(k))
    for group in groups:
        contexts = Contexts()
        for n, _ in group:
            decode_unit(rest, contexts, 0, n)
    return rest.bytes(len(integers))


def exact(k):
    """At most 24 significant bits (R-NET-012)."""
    drop = max(0, abs(k).bit_length() - 24)
    return (abs(k) >> drop << drop) * (1 if k >= 0 else -1)


def coded_nete(h, shifts, values):
    """The payload of NETE: the values, rounded to the grids of their units."""
    plans = [plan(hyperprior_shape(h), PHASE_BITS, 4096)] + [
        plan(shape, h.context_bits, 32767) for shape in slice_shapes(h)]
    groups, given, integers = list(coded_units(plans, shifts)), iter(values), []
    for group in groups:
        for n, exponent in group:
            integers += [exact(int(next(given) * 2.0 ** -exponent)) for _ in range(n)]
    return bytes(shifts) + b"\2" + coded(integers, groups)


def random_unit(rng, n):
    """The stored exponent of a unit and its n integers, all exact in binary32."""
    length = rng.randint(0, 24)
    exponent = rng.choice((-length - rng.randint(0, 4),) * 30 + (-126, min(127, 128 - length)))
    return exponent + 128, [exact(rng.randint(-(1 << length) + 1, (1 << length) - 1))
                            for _ in range(n)]


def random_blob(rng, groups):
    """The payload of NETR or BANK, of mode 2."""
    units = [random_unit(rng, n) for group in groups for n, _ in group]
    integers = [k for _, some in units for k in some]
    return b"\2" + bytes(e for e, _ in units) + coded(integers, groups)


def netr_groups(h):
    return [[(inputs, None)] * outputs + [(outputs, None)]
            for _, shape in tier_r_shapes(h) for inputs, outputs in layers(shape)]
