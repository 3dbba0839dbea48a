# SPDX-License-Identifier: BSD-2-Clause
"""Tensor blobs (7.2): the f32 values of networks and bank, raw, or shuffled and deflated, or, in
profile Compact, coded as integers (7.6). Order of judgement: R-NET-010."""

import struct
import zlib

from adaptive import Contexts, Rest, decode_unit
from floats import f32_sound
from verdict import Refusal, require


class Blob:
    """`patterns`: those of the values, in order. offset(i): where an error of value i is reported
    (chapter 14)."""

    def __init__(self, payload, name, count, groups=()):
        """groups: how mode 2 codes the values: for each reset of contexts, a list of units (number
        of values, exponent; None: it is in the file)."""
        self.start = payload.at + 1
        mode = payload.number("mode", 1)
        self.whole = mode > 0
        require(mode <= (2 if payload.compact else 1), "net.mode", self.start - 1)
        if mode == 2:
            self.patterns = self.coded(payload, count, groups)
        elif mode == 1:
            stream = payload.bytes(name + "_deflated", payload.end - payload.at)
            self.patterns = unshuffle(inflate(stream, 4 * count, self.start))
        else:
            self.patterns = payload.numbers(name, 4, count)

    def coded(self, payload, count, groups):
        stored = sum(exponent is None for group in groups for _, exponent in group)
        entries = iter([value - 128 for _, value in payload.entries("unit_exponent", 1, stored)])
        rest = Rest(payload, "weights_substream", count)
        self.start = rest.start
        values = []
        for group in groups:
            contexts = Contexts()
            for n, exponent in group:
                exponent = next(entries) if exponent is None else exponent
                values += decode_unit(rest, contexts, exponent, n)
        rest.finish()
        return values

    def offset(self, i):
        return self.start if self.whole else self.start + 4 * i

    def check_values(self):
        """R-NET-002 for blobs whose values obey no other rule."""
        for i, pattern in enumerate(self.patterns):
            require(f32_sound(pattern), "net.value", self.offset(i))


def inflate(stream, size, offset):
    """R-NET-001. Asking for one byte more than `size` lets zlib reach the end of the stream and its
    checksum, but never produce more than that.

    The inflate of zlib decides every point of R-NET-007 as that rule does; test_deflate.py has
    streams for each.
    """
    inflater = zlib.decompressobj()
    try:
        out = inflater.decompress(stream, size + 1)
    except zlib.error:
        raise Refusal("net.deflate", offset) from None
    whole = inflater.eof and not inflater.unused_data
    require(whole and len(out) == size and len(stream) < size, "net.deflate", offset)
    return out


def unshuffle(planes):
    """The patterns of values that are stored as byte 0 of all, then byte 1 of all, and so on."""
    n = len(planes) // 4
    values = bytearray(4 * n)
    for i in range(4):
        values[i::4] = planes[i * n:(i + 1) * n]
    return list(struct.unpack("<%dI" % n, values))
