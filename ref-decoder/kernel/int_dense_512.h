/* int_dense_512.h - the definitions for int_tile.h that int_dense_avx512.c and int_dense_vnni.c
 * share: everything for 512-bit vectors except dot(). SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_INT_DENSE_512_H
#define TED4_INT_DENSE_512_H

#include <immintrin.h>
#include <string.h>
#include "kernel/int_kernel.h"

enum { GROUP = 32, UNITS = 8 };

typedef __m512i vector;

/* 32 anchors of two channels, or their sums. Of every eight anchors, the first four are in lo and
 * the others in hi; packing restores their order. */
typedef struct {
    vector lo, hi;
} pair;

static inline vector nothing(void)
{
    return _mm512_setzero_si512();
}

static inline vector load(const int16_t *x)
{
    return _mm512_loadu_si512((const void *)x);
}

static inline vector low(vector a, vector b)
{
    return _mm512_unpacklo_epi16(a, b);
}

static inline vector high(vector a, vector b)
{
    return _mm512_unpackhi_epi16(a, b);
}

static inline vector all(int32_t x)
{
    return _mm512_set1_epi32(x);
}

static inline vector both(const int16_t *w)
{
    int32_t two;

    memcpy(&two, w, sizeof two);
    return all(two);
}

static inline vector shift(vector sum, unsigned r)
{
    return _mm512_sra_epi32(_mm512_add_epi32(sum, all(r > 0 ? 1 << (r - 1) : 0)),
                            _mm_cvtsi32_si128((int)r));
}

static inline void store_hidden(int16_t *y, pair sum)
{
    _mm512_storeu_si512((void *)y, _mm512_max_epi16(_mm512_packs_epi32(sum.lo, sum.hi), nothing()));
}

static inline void store_last(int32_t *y, pair sum)
{
    const vector most = all(TED4_OUTPUT_MAX), least = all(-TED4_OUTPUT_MAX);
    const vector first = _mm512_setr_epi64(0, 1, 8, 9, 2, 3, 10, 11);
    const vector second = _mm512_setr_epi64(4, 5, 12, 13, 6, 7, 14, 15);
    const vector lo = _mm512_max_epi32(_mm512_min_epi32(sum.lo, most), least);
    const vector hi = _mm512_max_epi32(_mm512_min_epi32(sum.hi, most), least);

    _mm512_storeu_si512((void *)y, _mm512_permutex2var_epi64(lo, first, hi));
    _mm512_storeu_si512((void *)(y + 16), _mm512_permutex2var_epi64(lo, second, hi));
}

#endif
