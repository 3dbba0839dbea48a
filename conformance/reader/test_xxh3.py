# SPDX-License-Identifier: BSD-2-Clause
"""XXH3 against values made with libxxhash 0.8.1, and against that library where it is installed."""

import ctypes
import ctypes.util
import random
import unittest

from xxh3 import xxh3_128, xxh3_64

# Length n of the input 1, 8, 15, ... (7 i + 1 mod 256), and both hashes: every branch of the
# algorithm, at its limits.
KNOWN = """
0     2d06800538d394c2 99aa06d3014798d86001c324468d497f
1     e12ef9d2eb86ceeb 51025a4491835505e12ef9d2eb86ceeb
3     5c83885a0fb5d516 f727126d6288a4bd5c83885a0fb5d516
4     244f36de481e7522 6a20c426eb2da17d217908f07519e96e
8     96cc97a6768fd7a9 dd669d5507e0e9404506373ef0af21f8
9     4781d83b8e99d495 781bfd0e8d95a9ada51b142882780bcb
16    913bd4a8038027a7 6c53b945f90d679849bf196d35649b79
17    2bf6f66973a6179d f889d91b7faf208294ad051aea796d7e
32    5d503b89ae6f56c6 2cb559bb64d293e9369cab951c511911
64    13886553e7dc3fa3 49b043631b5d4d5192fd891d246fb531
128   c4399c7829d0628f 776e5a2cae08df3bd480e3bdeadbf37f
129   8433489056750b32 b550da2f042256556a4dda91524c13ef
240   3c0bb96864e543a1 3f558c88fda1da664f23bfd3609734e8
241   bff7215089202d8f 9ea4272027cb71fcbff7215089202d8f
1024  ac8e32e4ea3ba062 418876ca5eaea67dac8e32e4ea3ba062
1025  c856c953bbdbc807 f66a602aa3eda73bc856c953bbdbc807
5000  882162ebfafc2c3f 41e4bc877e39437f882162ebfafc2c3f
"""


class Known(unittest.TestCase):
    def test_known_values(self):
        for line in KNOWN.split("\n")[1:-1]:
            n, h64, h128 = line.split()
            data = bytes(7 * i + 1 & 255 for i in range(int(n)))
            self.assertEqual(h64, "%016x" % xxh3_64(data), n)
            self.assertEqual(h128, xxh3_128(data).hex(), n)


class Halves(ctypes.Structure):
    _fields_ = [("low", ctypes.c_uint64), ("high", ctypes.c_uint64)]


@unittest.skipUnless(ctypes.util.find_library("xxhash"), "libxxhash is not there")
class Library(unittest.TestCase):
    def test_every_length(self):
        library = ctypes.CDLL(ctypes.util.find_library("xxhash"))
        library.XXH3_64bits.restype, library.XXH3_128bits.restype = ctypes.c_uint64, Halves
        for function in (library.XXH3_64bits, library.XXH3_128bits):
            function.argtypes = [ctypes.c_char_p, ctypes.c_size_t]
        rng = random.Random(1)
        for n in list(range(400)) + [1023, 1024, 1025, 1087, 1088, 1089, 2048, 2049, 9999]:
            data = bytes(rng.randrange(256) for _ in range(n))
            self.assertEqual(library.XXH3_64bits(data, n), xxh3_64(data), n)
            halves = library.XXH3_128bits(data, n)
            self.assertEqual((halves.high << 64 | halves.low).to_bytes(16, "big"),
                             xxh3_128(data), n)


if __name__ == "__main__":
    unittest.main()
