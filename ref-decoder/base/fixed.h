/* fixed.h - spec 4.3: integer operations, named after the way they round. They neither overflow nor
 * shift negative values.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_FIXED_H
#define TED4_FIXED_H

#include <stdint.h>

/* Returns floor(x / 2^r); r < 32. */
static inline int32_t ted4_floor_shift(int32_t x, unsigned r)
{
    return x >= 0 ? x >> r : ~(~x >> r);
}

/* Returns x / 2^r rounded to nearest, with ties rounded up; r < 32. The caller ensures that
 * x + 2^(r-1) does not overflow. */
static inline int32_t ted4_round_shift(int32_t x, unsigned r)
{
    return r == 0 ? x : ted4_floor_shift(x + ((int32_t)1 << (r - 1)), r);
}

static inline int32_t ted4_clamp(int32_t x, int32_t low, int32_t high)
{
    return x < low ? low : x > high ? high : x;
}

/* Returns x saturated to 16 bits. The result is never -32768, so negating it cannot overflow
 * (spec 4.3). */
static inline int32_t ted4_sat16(int32_t x)
{
    return ted4_clamp(x, -32767, 32767);
}

/* spec 4.3: returns rne(v 2^e), where bits is the pattern of the binary32 v, which is zero or
 * normal. Results beyond +-2^62 are clamped to +-2^62, which is outside every bound of the
 * specification. */
static inline int64_t ted4_rne_scaled(uint32_t bits, int e)
{
    const int64_t huge = (int64_t)1 << 62;
    const int shift = (int)(bits >> 23 & 0xff) - 150 + e;
    const int64_t m = (bits & 0x7fffffff) == 0 ? 0 : (int64_t)((bits & 0x7fffff) | 0x800000);
    int64_t v;

    if (shift >= 0) {
        v = shift > 38 && m != 0 ? huge : m << (shift > 38 ? 0 : shift);
    } else if (shift < -25) {
        v = 0;
    } else {
        const int64_t half = (int64_t)1 << (-shift - 1);
        const int64_t rest = m & (2 * half - 1);

        v = m >> -shift;
        v += rest > half || (rest == half && (v & 1) != 0);
    }
    return bits >> 31 ? -v : v;
}

/* Returns floor(log2 x) for x > 0. */
static inline unsigned ted4_log2_floor(uint32_t x)
{
    unsigned n = 0;

    for (unsigned step = 16; step > 0; step /= 2)
        if (x >> step != 0) {
            x >>= step;
            n += step;
        }
    return n;
}

#endif
