# SPDX-License-Identifier: BSD-2-Clause
"""R-NET-007 point by point: streams written bit by bit, and what blob.inflate says about them."""

import struct
import unittest
import zlib

from blob import inflate
from verdict import Refusal

ORDER = (16, 17, 18, 0, 8, 7, 9, 6, 10, 5, 11, 4, 12, 3, 13, 2, 14, 1, 15)      # RFC 1951, 3.2.7
FIXED = [8] * 144 + [9] * 112 + [7] * 24 + [8] * 8
SIZE = 400


class Bits:
    """A DEFLATE bit string; numbers go in from their lowest bit, codes from their highest."""

    def __init__(self):
        self.bits = []

    def number(self, value, count):
        self.bits += [value >> i & 1 for i in range(count)]
        return self

    def code(self, lengths, symbol):
        """The canonical code of a symbol (RFC 1951, 3.2.2)."""
        value = 0
        for length in range(1, lengths[symbol] + 1):
            value = value + sum(1 for n in lengths if n == length - 1 and n) << 1
        value += sum(1 for n in lengths[:symbol] if n == lengths[symbol])
        self.bits += [value >> i & 1 for i in reversed(range(lengths[symbol]))]
        return self

    def stored(self, content, wrong=0, skipped=0):
        while len(self.bits) % 8:
            self.bits.append(skipped)
        for byte in struct.pack("<HH", len(content), len(content) ^ 0xFFFF ^ wrong) + content:
            self.number(byte, 8)
        return self

    def bytes(self, padding=0):
        bits = self.bits + [padding] * (-len(self.bits) % 8)
        return bytes(sum(bit << i for i, bit in enumerate(bits[at:at + 8]))
                     for at in range(0, len(bits), 8))


def dynamic(bits, literal, distance, pieces=None, code_lengths=None, hlit=None, hdist=None):
    """Head of a dynamic block: pieces are the symbols of the code length code, each (symbol, extra
    bits, their count)."""
    # 16 codes of 5 bits, two of 2 bits: complete
    code_lengths = code_lengths or [5] * 16 + [2, 0, 2]
    pieces = pieces or [(n, 0, 0) for n in literal + distance]
    bits.number((hlit or len(literal)) - 257, 5)
    bits.number((hdist or len(distance)) - 1, 5).number(15, 4)
    for symbol in ORDER:
        bits.number(code_lengths[symbol], 3)
    for symbol, extra, count in pieces:
        bits.code(code_lengths, symbol).number(extra, count)
    return bits


def last_fixed():
    return Bits().number(1, 1).number(1, 2)


def last_dynamic(*arguments, **names):
    return dynamic(Bits().number(1, 1).number(2, 2), *arguments, **names)


def valid(body, content=bytes(SIZE), head=b"\x78\x9c", check=0):
    stream = head + body + struct.pack(">I", zlib.adler32(content) ^ check)
    try:
        return inflate(stream, len(content), 0) == content
    except Refusal:
        return False


def zeros(bits, literal, distance):
    """400 zeros and the end: a literal, then 258 and 141 bytes from one byte before. Uses symbols
    0, 285, 281 (lengths from 131 on), 256; distance 0."""
    bits.code(literal, 0).code(literal, 285).code(distance, 0)
    return bits.code(literal, 281).number(141 - 131, 5).code(distance, 0).code(literal, 256)


LITERAL = [2] + [0] * 255 + [2] + [0] * 24 + [2, 0, 0, 0, 2]    # 0, 256, 281 and 285, two bits each


class Head(unittest.TestCase):
    def test_head(self):
        body = zeros(last_fixed(), FIXED, [5] * 30).bytes()
        for cinfo in range(16):
            for level in range(4):
                first, second = cinfo << 4 | 8, level << 6
                right = second + -(256 * first + second) % 31
                self.assertEqual(cinfo <= 7, valid(body, head=bytes((first, right))),
                                 (cinfo, level))
                self.assertFalse(valid(body, head=bytes((first, right ^ 1))))
        self.assertFalse(valid(body, head=bytes((0x79, -256 * 0x79 % 31))))  # CM
        self.assertFalse(valid(body, head=bytes((0x78, 32 + -(256 * 0x78 + 32) % 31))))  # FDICT
        self.assertFalse(valid(body, check=1))

    def test_end(self):
        bits = zeros(last_fixed(), FIXED, [5] * 30)
        self.assertNotEqual(0, len(bits.bits) % 8)
        self.assertTrue(valid(bits.bytes(padding=1)))


class Blocks(unittest.TestCase):
    def test_stored(self):
        def stream(content, **names):
            return zeros(Bits().number(0, 3).stored(content, **names).number(1, 1).number(1, 2),
                         FIXED, [5] * 30).bytes()
        self.assertTrue(valid(stream(b"", skipped=1)))
        self.assertFalse(valid(stream(b"", wrong=256)))
        self.assertTrue(valid(stream(b"\7"), b"\7" + bytes(SIZE)))
        # type 3
        self.assertFalse(valid(zeros(Bits().number(1, 1).number(3, 2), FIXED, [5] * 30).bytes()))

    def test_distances(self):
        far = [5] * 30
        # distance 32768 with so many bytes before
        for extra, size, expected in ((8191, 32768, True), (8191, 32767, False)):
            content = bytes(range(1, 8)) + bytes(size - 7)
            bits = Bits().number(0, 3).stored(content).number(1, 1).number(1, 2)
            bits.code(FIXED, 257).code(far, 29).number(extra, 13)
            for _ in range(200):
                bits.code(FIXED, 285).code(far, 0)
            body = bits.code(FIXED, 256).bytes()
            made = content + content[-32768:][:3] + bytes([content[-32768:][2]]) * 200 * 258
            for head in (b"\x78\x9c", b"\x08\x1d"):  # windows of 32 KiB and of 256 bytes
                self.assertEqual(expected, valid(body, made, head))

    def test_symbols_that_do_not_occur(self):
        for symbol in (286, 287):
            self.assertFalse(
                valid(last_fixed().code(FIXED, symbol).code([5] * 30, 0).code(FIXED, 256).bytes()))
        for symbol in (30, 31):
            bits = last_fixed().code(FIXED, 0).code(FIXED, 285).code([5] * 32, symbol)
            self.assertFalse(valid(bits.code(FIXED, 256).bytes(), bytes(259)))


class Size(unittest.TestCase):
    def test_shorter_than_raw(self):
        """R-NET-001. A stream of 9 stored bytes and a run of zeros has 24 bytes: with 15 zeros as
        many as come out, with 16 one less."""
        for symbol, extra, zero_count in ((266, 1, 15), (267, 0, 16)):
            bits = Bits().number(0, 3).stored(b"stored by").number(1, 1).number(1, 2)
            bits.code(FIXED, 0).code(FIXED, symbol).number(extra, 1)
            bits.code([5] * 30, 0).code(FIXED, 256)
            self.assertEqual(24, 2 + len(bits.bytes()) + 4)
            self.assertEqual(zero_count == 16,
                             valid(bits.bytes(), b"stored by" + bytes(zero_count)))


class Codes(unittest.TestCase):
    def test_distance_codes(self):
        self.assertTrue(valid(zeros(last_dynamic(LITERAL, [1]), LITERAL, [1]).bytes()))
        self.assertTrue(valid(zeros(last_dynamic(LITERAL, [1, 1]), LITERAL, [1, 1]).bytes()))
        # incomplete
        self.assertFalse(valid(zeros(last_dynamic(LITERAL, [2]), LITERAL, [2]).bytes()))
        # too many
        self.assertFalse(valid(zeros(last_dynamic(LITERAL, [1, 1, 1]), LITERAL, [1, 1]).bytes()))
        only = [1] + [0] * 255 + [1]
        bits = last_dynamic(only, [0])
        for _ in range(SIZE):
            bits.code(only, 0)
        self.assertTrue(valid(bits.code(only, 256).bytes()))  # none, none used
        # none, but used
        self.assertFalse(valid(zeros(last_dynamic(LITERAL, [0]), LITERAL, [1]).bytes()))

    def test_literal_codes(self):
        def behind(literal, first):
            """A block with that code, which holds nothing but its end, then the zeros."""
            bits = dynamic(Bits().number(0, 1).number(2, 2), literal, [1])
            bits.code(literal, first)
            return zeros(bits.number(1, 1).number(1, 2), FIXED, [5] * 30).bytes()
        self.assertTrue(valid(behind([0] * 256 + [1], 256)))  # one code of length 1
        self.assertFalse(valid(behind([0] * 256 + [2], 256)))
        self.assertFalse(valid(behind([1] + [0] * 256, 0)))  # no 256
        self.assertFalse(valid(behind([2, 2] + [0] * 254 + [2], 256)))  # incomplete
        self.assertFalse(valid(behind([1, 1] + [0] * 254 + [1], 256)))  # too many

    def test_counts(self):
        for literals, distances, expected in ((286, 30, True), (287, 1, False), (288, 1, False),
                                              (286, 31, False), (286, 32, False)):
            literal = LITERAL + [0] * (literals - 286)
            distance = [1] + [0] * (distances - 1)
            self.assertEqual(expected, valid(zeros(last_dynamic(literal, distance), literal,
                                                   distance).bytes()), (literals, distances))

    def test_code_length_code(self):
        missing = [5] * 15 + [0, 2, 0, 2]
        self.assertFalse(
            valid(zeros(last_dynamic(LITERAL, [1], code_lengths=missing), LITERAL, [1]).bytes()))
        many = [5] * 16 + [2, 5, 2]
        self.assertFalse(
            valid(zeros(last_dynamic(LITERAL, [1], code_lengths=many), LITERAL, [1]).bytes()))

    def test_repeats(self):
        pieces = [(2, 0, 0), (18, 127, 7), (18, 255 - 138 - 11, 7), (2, 0, 0), (18, 24 - 11, 7),
                  (2, 0, 0), (0, 0, 0), (0, 0, 0), (0, 0, 0), (2, 0, 0)]
        one, some = [(1, 0, 0)], [(1, 0, 0), (16, 0, 2)]
        self.assertTrue(
            valid(zeros(last_dynamic(LITERAL, [1], pieces + one), LITERAL, [1]).bytes()))
        # beyond the last
        self.assertFalse(
            valid(zeros(last_dynamic(LITERAL, [1], pieces + some), LITERAL, [1]).bytes()))
        self.assertFalse(valid(zeros(last_dynamic(LITERAL, [1], [(16, 0, 2)] + pieces[1:] + one),
                                     LITERAL, [1]).bytes()))


if __name__ == "__main__":
    unittest.main()
