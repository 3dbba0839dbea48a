/* half.h - spec 8: converts binary16 patterns to exact integers, sort keys and binary32, using bit
 * operations only.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_HALF_H
#define TED4_HALF_H

#include <stdint.h>
#include "base/bytes.h"
#include "base/fixed.h"

/* Returns X of spec 8: the value times 2^24, which is exact. |value| <= 1, so the exponent field is
 * at most 15. */
static inline int32_t ted4_half_q24(uint16_t h)
{
    const unsigned e = h >> 10 & 15;
    const int32_t m = h & 0x3ff;
    const int32_t x = e > 0 ? (m | 0x400) << (e - 1) : m;

    return h >> 15 ? -x : x;
}

/* Converts binary16 to binary32, exactly. */
static inline float ted4_half_to_float(uint16_t h)
{
    const uint32_t sign = (uint32_t)(h >> 15) << 31;
    uint32_t e = h >> 10 & 31, m = h & 0x3ff;

    if (e == 31)
        return ted4_bits_float(sign | 0x7f800000 | m << 13);
    if (e == 0) {
        if (m == 0)
            return ted4_bits_float(sign);
        for (e = 1; m < 0x400; e--) /* may wrap around below 0; adding 112 undoes that */
            m <<= 1;
        m &= 0x3ff;
    }
    return ted4_bits_float(sign | (e + 112) << 23 | m << 13);
}

/* Converts binary32 to binary16, rounding to nearest with ties to even. Values beyond the largest
 * binary16 become infinity. */
static inline uint16_t ted4_float_to_half(float x)
{
    const uint32_t bits = ted4_float_bits(x);
    const uint32_t sign = bits >> 16 & 0x8000, u = bits & 0x7fffffff;
    const uint32_t e = u >> 23;
    uint32_t shift, m, v, rest, half;

    if (u > 0x7f800000)
        return (uint16_t)(sign | 0x7e00);
    if (e >= 143)
        return (uint16_t)(sign | 0x7c00);
    if (e < 102)
        return (uint16_t)sign;
    m = (u & 0x7fffff) | 0x800000;
    shift = e >= 113 ? 13 : 126 - e;
    half = (uint32_t)1 << (shift - 1);
    rest = m & (2 * half - 1);
    v = m >> shift;
    if (e >= 113)
        v += (e - 113) << 10; /* v already contains 1 << 10 */
    v += rest > half || (rest == half && (v & 1) != 0);
    return (uint16_t)(sign | v);
}

/* spec 8: maps a pattern to an integer; the map preserves the order of values. */
static inline uint32_t ted4_half_order(uint16_t h)
{
    return h < 0x8000 ? h + 0x8000u : 0xffffu - h;
}

/* Moves bit i of x to bit 3 i; x < 2^16. */
static inline uint64_t ted4_spread3(uint64_t x)
{
    x = (x | x << 16) & 0x0000ff0000ff;
    x = (x | x << 8) & 0x00f00f00f00f;
    x = (x | x << 4) & 0x0c30c30c30c3;
    x = (x | x << 2) & 0x249249249249;
    return x;
}

/* spec 8: returns the 48-bit Morton code of an anchor's position, p[3]. */
static inline uint64_t ted4_morton(const uint16_t *p)
{
    return ted4_spread3(ted4_half_order(p[0])) << 2 | ted4_spread3(ted4_half_order(p[1])) << 1 |
           ted4_spread3(ted4_half_order(p[2]));
}

/* spec 8.2: returns whether positions may lie on a grid of so many bits. */
static inline int ted4_grid_exists(unsigned depth)
{
    return (depth >= 6 && depth <= 12) || depth == 16;
}

/* spec 8.2: returns the place, on a grid of depth bits (1 .. 12, or 16), of a legal coordinate, or
 * UINT32_MAX if it is none of the grid's. */
static inline uint32_t ted4_grid_place(uint16_t h, unsigned depth)
{
    int32_t x, cell, half;

    if (depth == 16)
        return ted4_half_order(h);
    x = ted4_half_q24(h);
    cell = (int32_t)1 << (25 - depth);
    half = (int32_t)1 << (depth - 1);
    return x % cell != 0 || x / cell == half ? UINT32_MAX : (uint32_t)(x / cell + half);
}

/* spec 8.2: returns the pattern of the coordinate at a place. With depth 16 it may be illegal. */
static inline uint16_t ted4_grid_half(uint32_t place, unsigned depth)
{
    const int32_t m = (int32_t)place - ((int32_t)1 << (depth - 1));
    const uint32_t sign = m < 0 ? 0x8000 : 0;
    uint32_t x, e;

    if (depth == 16)
        return (uint16_t)(place >= 0x8000 ? place - 0x8000 : 0xffff - place);
    x = (uint32_t)(m < 0 ? -m : m) << (25 - depth); /* the coordinate times 2^24 */
    if (x == 0)
        return 0;
    e = ted4_log2_floor(x); /* 13 or more: the number is normal */
    return (uint16_t)(sign | (e - 9) << 10 | (x >> (e - 10) & 0x3ff));
}

/* Inverse of ted4_spread3: moves bit 3 i of x to bit i, and drops the other bits. */
static inline uint32_t ted4_gather3(uint64_t x)
{
    x &= 0x249249249249;
    x = (x | x >> 2) & 0x0c30c30c30c3;
    x = (x | x >> 4) & 0x00f00f00f00f;
    x = (x | x >> 8) & 0x0000ff0000ff;
    return (uint32_t)((x | x >> 16) & 0xffff);
}

#endif
