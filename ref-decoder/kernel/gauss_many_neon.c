/* gauss_many_neon.c - instantiates gauss_tile.h for NEON, with vectors of four lanes.
 * SPDX-License-Identifier: BSD-2-Clause */
#if defined(__AARCH64EL__)

#include <arm_neon.h>
#include <string.h>

#define VECTOR 16
#include "kernel/gauss_vector.h"
#include "kernel/word_places.h"
#include "norm/tables.h"

typedef vi mask; /* per lane: all bits set, or none */

static inline vi all(int32_t x)
{
    return (vi)vdupq_n_s32(x);
}

static inline vi least(vi a, vi b)
{
    return (vi)vminq_s32((int32x4_t)a, (int32x4_t)b);
}

static inline vi most(vi a, vi b)
{
    return (vi)vmaxq_s32((int32x4_t)a, (int32x4_t)b);
}

static inline mask less(vi a, vi b)
{
    return (vi)vcltq_s32((int32x4_t)a, (int32x4_t)b);
}

static inline mask equal(vi a, vi b)
{
    return (vi)vceqq_s32((int32x4_t)a, (int32x4_t)b);
}

static inline mask either(mask a, mask b)
{
    return a | b;
}

static inline mask lanes_of(unsigned bits)
{
    const vi bit = { 1, 2, 4, 8 };

    return equal(all((int32_t)bits) & bit, bit);
}

static inline unsigned bits_of(mask m)
{
    const vi bit = { 1, 2, 4, 8 };

    return (unsigned)vaddvq_s32((int32x4_t)(m & bit));
}

static inline vi choose(mask m, vi yes, vi no)
{
    return (vi)vbslq_s32((uint32x4_t)m, (int32x4_t)yes, (int32x4_t)no);
}

static inline void pairs(const int32_t *table, vi index, vi *low, vi *high)
{
    const int32x4_t a = vcombine_s32(vld1_s32(table + index[0]), vld1_s32(table + index[1]));
    const int32x4_t b = vcombine_s32(vld1_s32(table + index[2]), vld1_s32(table + index[3]));

    *low = (vi)vuzp1q_s32(a, b);
    *high = (vi)vuzp2q_s32(a, b);
}

static inline vi indices(const uint8_t *sigma)
{
    return (vi) { sigma[0], sigma[1], sigma[2], sigma[3] };
}

/* Looks up bytes 0 to 3 of each lane's table entry. */
static inline vi scales(vi sigma)
{
    const int32_t *step = ted4_stepi + 128;
    uint8x16x4_t even;

    for (int i = 0; i < 4; i++)
        even.val[i] = vreinterpretq_u8_s32(vld2q_s32(step + 8 * i).val[0]);
    return (vi)vqtbl4q_u8(even, (uint8x16_t)((sigma & 15) * 0x04040404 + 0x03020100));
}

static inline vi expand(unsigned wants, const uint8_t *words)
{
    const uint8x16_t four = vcombine_u8(vld1_u8(words), vdup_n_u8(0));

    return (vi)vqtbl1q_u8(four, vld1q_u8(ted4_word_places[wants]));
}

static inline void narrow(int16_t *to, vi x)
{
    vst1_s16(to, vmovn_s32((int32x4_t)x));
}

#include "kernel/gauss_tile.h"

size_t ted4_gauss_many_neon(ted4_gauss_lanes *d, size_t n, const int32_t *mu, const uint8_t *sigma,
                            int16_t *k)
{
    return many(d, n, mu, sigma, k);
}

#else
typedef int ted4_gauss_many_neon_is_for_aarch64;
#endif
