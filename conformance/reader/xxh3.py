# SPDX-License-Identifier: BSD-2-Clause
"""XXH3-64 and XXH3-128 with seed 0 (xxHash 0.8 specification), for chapters 5 and 15 and annex J.

There are three methods, by length: up to 16 bytes, up to 240 bytes, and longer, with eight
accumulators of 64 bits over stripes of 64 bytes.
"""

import struct

SECRET = bytes.fromhex(
    "b8fe6c3923a44bbe7c01812cf721ad1cded46de9839097db7240a4a4b7b3671f"
    "cb79e64eccc0e578825ad07dccff7221b8084674f743248ee03590e6813a264c"
    "3c2852bb91c300cb88d0658b1b532ea371644897a20df94e3819ef46a9deacd8"
    "a8fa763fe39c343ff9dcbbc7c70b4f1d8a51e04bcdb45931c89f7ec9d9787364"
    "eac5ac8334d3ebc3c581a0fffa1363eb170ddd51b7f0da49d316552629d4689e"
    "2b16be587d47a1fc8ff8b8d17ad031ce45cb3a8f95160428afd7fbcabb4b407e")

M32 = 0xFFFFFFFF
M64 = 0xFFFFFFFFFFFFFFFF
A1, A2, A3 = 0x9E3779B1, 0x85EBCA77, 0xC2B2AE3D                               # primes of 32 bits
B1, B2, B3 = 0x9E3779B185EBCA87, 0xC2B2AE3D27D4EB4F, 0x165667B19E3779F9         # primes of 64 bits
B4, B5 = 0x85EBCA77C2B2AE63, 0x27D4EB2F165667C5
MIX1, MIX2 = 0x165667919E3779F9, 0x9FB21C651E98DF25
BLOCK = 1024  # 16 stripes, then a scramble


def u32(data, at):
    return int.from_bytes(data[at:at + 4], "little")


def u64(data, at):
    return int.from_bytes(data[at:at + 8], "little")


def secret(at):
    return u64(SECRET, at)


def swap64(x):
    return int.from_bytes(x.to_bytes(8, "little"), "big")


def fold(a, b):
    """The 128-bit product of two 64-bit numbers, its halves xored."""
    p = a * b
    return p & M64 ^ p >> 64


def avalanche(h):
    h = (h ^ h >> 37) * MIX1 & M64
    return h ^ h >> 32


def avalanche64(h):
    """The final mix of XXH64, used for the shortest inputs."""
    h = (h ^ h >> 33) * B2 & M64
    h = (h ^ h >> 29) * B3 & M64
    return h ^ h >> 32


def rotl(x, r, bits):
    return (x << r | x >> bits - r) & (1 << bits) - 1


def mix16(data, at, s):
    """16 bytes of data with 16 bytes of the secret at s."""
    return fold(u64(data, at) ^ secret(s), u64(data, at + 8) ^ secret(s + 8))


def few(data, n):
    """1 to 3 bytes in one word of 32 bits."""
    return data[0] << 16 | data[n >> 1] << 24 | data[n - 1] | n << 8


def accumulate(data, n):
    """The eight accumulators after an input of more than 240 bytes."""
    acc = [A3, B1, B2, B3, B4, A2, B5, A1]
    keys = [struct.unpack_from("<8Q", SECRET, 8 * s) for s in range(16)]
    for at in range(0, n - BLOCK, BLOCK):
        words = struct.unpack_from("<128Q", data, at)
        for s in range(16):
            stripe(acc, words[8 * s:8 * s + 8], keys[s])
        for i, k in enumerate(struct.unpack_from("<8Q", SECRET, 128)):
            acc[i] = (acc[i] ^ acc[i] >> 47 ^ k) * A1 & M64
    at = (n - 1) // BLOCK * BLOCK
    for s in range((n - 1 - at) // 64):
        stripe(acc, struct.unpack_from("<8Q", data, at + 64 * s), keys[s])
    stripe(acc, struct.unpack_from("<8Q", data, n - 64), struct.unpack_from("<8Q", SECRET, 121))
    return acc


def stripe(acc, words, key):
    """Adds 64 bytes: each word to its neighbour's accumulator, the product of its keyed halves to
    its own."""
    for i in (0, 2, 4, 6):
        a, b = words[i], words[i + 1]
        x, y = a ^ key[i], b ^ key[i + 1]
        acc[i] = acc[i] + b + (x & M32) * (x >> 32) & M64
        acc[i + 1] = acc[i + 1] + a + (y & M32) * (y >> 32) & M64


def merge(acc, s, start):
    return avalanche(
        (start + sum(fold(acc[i] ^ secret(s + 8 * i), acc[i + 1] ^ secret(s + 8 * i + 8))
                     for i in (0, 2, 4, 6))) & M64)


def xxh3_64(data):
    """XXH3-64 of a bytes-like object, as a number."""
    data = bytes(data)
    n = len(data)
    if n > 240:
        return merge(accumulate(data, n), 11, n * B1 & M64)
    if n > 16:
        return middle_64(data, n)
    if n > 8:
        lo = u64(data, 0) ^ secret(24) ^ secret(32)
        hi = u64(data, n - 8) ^ secret(40) ^ secret(48)
        return avalanche((n + swap64(lo) + hi + fold(lo, hi)) & M64)
    if n > 3:
        h = u32(data, n - 4) + (u32(data, 0) << 32) ^ secret(8) ^ secret(16)
        h = (h ^ rotl(h, 49, 64) ^ rotl(h, 24, 64)) * MIX2 & M64
        h = (h ^ (h >> 35) + n) * MIX2 & M64
        return h ^ h >> 28
    if n > 0:
        return avalanche64(few(data, n) ^ u32(SECRET, 0) ^ u32(SECRET, 4))
    return avalanche64(secret(56) ^ secret(64))


def middle_64(data, n):
    """17 to 240 bytes."""
    h = n * B1
    if n <= 128:
        for i in range((n - 1) // 32, -1, -1):
            h += mix16(data, 16 * i, 32 * i) + mix16(data, n - 16 * (i + 1), 32 * i + 16)
        return avalanche(h & M64)
    h = avalanche((h + sum(mix16(data, 16 * i, 16 * i) for i in range(8))) & M64)
    h += sum(mix16(data, 16 * i, 16 * (i - 8) + 3) for i in range(8, n // 16))
    return avalanche((h + mix16(data, n - 16, 119)) & M64)


def xxh3_128(data):
    """XXH3-128 of a bytes-like object, as 16 bytes in canonical (big-endian) form."""
    data = bytes(data)
    n = len(data)
    if n > 240:
        acc = accumulate(data, n)
        lo, hi = merge(acc, 11, n * B1 & M64), merge(acc, 117, n * B2 & M64 ^ M64)
    elif n > 16:
        lo, hi = middle_128(data, n)
    elif n > 8:
        lo, hi = short_128(data, n)
    elif n > 3:
        p = (u32(data, 0) + (u32(data, n - 4) << 32) ^ secret(16) ^ secret(24)) * (B1 + 4 * n)
        lo, hi = p & M64, p >> 64
        hi = hi + 2 * lo & M64
        lo ^= hi >> 3
        lo = (lo ^ lo >> 35) * MIX2 & M64
        lo, hi = lo ^ lo >> 28, avalanche(hi)
    elif n > 0:
        word = few(data, n)
        turned = rotl(int.from_bytes(word.to_bytes(4, "little"), "big"), 13, 32)
        lo = avalanche64(word ^ u32(SECRET, 0) ^ u32(SECRET, 4))
        hi = avalanche64(turned ^ u32(SECRET, 8) ^ u32(SECRET, 12))
    else:
        lo, hi = avalanche64(secret(64) ^ secret(72)), avalanche64(secret(80) ^ secret(88))
    return (hi << 64 | lo).to_bytes(16, "big")


def short_128(data, n):
    """9 to 16 bytes."""
    a, b = u64(data, 0), u64(data, n - 8)
    p = (a ^ b ^ secret(32) ^ secret(40)) * B1
    lo, hi = (p & M64) + (n - 1 << 54) & M64, p >> 64
    b ^= secret(48) ^ secret(56)
    hi = hi + b + (b & M32) * (A2 - 1) & M64
    p = (lo ^ swap64(hi)) * B2
    return avalanche(p & M64), avalanche((p >> 64) + hi * B2 & M64)


def middle_128(data, n):
    """17 to 240 bytes."""
    lo, hi = n * B1 & M64, 0

    def mix32(a, b, s):
        nonlocal lo, hi
        lo = lo + mix16(data, a, s) & M64 ^ u64(data, b) + u64(data, b + 8) & M64
        hi = hi + mix16(data, b, s + 16) & M64 ^ u64(data, a) + u64(data, a + 8) & M64

    if n <= 128:
        for i in range((n - 1) // 32, -1, -1):
            mix32(16 * i, n - 16 * (i + 1), 32 * i)
    else:
        for i in range(4):
            mix32(32 * i, 32 * i + 16, 32 * i)
        lo, hi = avalanche(lo), avalanche(hi)
        for i in range(4, n // 32):
            mix32(32 * i, 32 * i + 16, 3 + 32 * (i - 4))
        mix32(n - 16, n - 32, 103)
    return avalanche(lo + hi & M64), -avalanche(lo * B1 + hi * B4 + n * B2 & M64) & M64
