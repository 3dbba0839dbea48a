/* int_dense_avx2.c - instantiates int_tile.h for AVX2.
 * SPDX-License-Identifier: BSD-2-Clause */
#if defined(__x86_64__)

#include <immintrin.h>
#include <string.h>
#include "kernel/int_kernel.h"

enum { GROUP = 16, UNITS = 4 };

typedef __m256i vector;

/* 16 anchors of two channels, or their sums. Unpacking puts anchors 0-3 and 8-11 into lo, and 4-7
 * and 12-15 into hi; packing restores their order. */
typedef struct {
    vector lo, hi;
} pair;

static inline vector nothing(void)
{
    return _mm256_setzero_si256();
}

static inline vector load(const int16_t *x)
{
    return _mm256_loadu_si256((const void *)x);
}

static inline vector low(vector a, vector b)
{
    return _mm256_unpacklo_epi16(a, b);
}

static inline vector high(vector a, vector b)
{
    return _mm256_unpackhi_epi16(a, b);
}

static inline vector all(int32_t x)
{
    return _mm256_set1_epi32(x);
}

static inline vector both(const int16_t *w)
{
    int32_t two;

    memcpy(&two, w, sizeof two);
    return all(two);
}

static inline vector dot(vector sum, vector x, vector w)
{
    return _mm256_add_epi32(sum, _mm256_madd_epi16(x, w));
}

static inline vector shift(vector sum, unsigned r)
{
    return _mm256_sra_epi32(_mm256_add_epi32(sum, all(r > 0 ? 1 << (r - 1) : 0)),
                            _mm_cvtsi32_si128((int)r));
}

static inline void store_hidden(int16_t *y, pair sum)
{
    _mm256_storeu_si256((void *)y, _mm256_max_epi16(_mm256_packs_epi32(sum.lo, sum.hi), nothing()));
}

static inline void store_last(int32_t *y, pair sum)
{
    const vector most = all(TED4_OUTPUT_MAX), least = all(-TED4_OUTPUT_MAX);
    const vector u = _mm256_max_epi32(_mm256_min_epi32(sum.lo, most), least);
    const vector v = _mm256_max_epi32(_mm256_min_epi32(sum.hi, most), least);

    _mm256_storeu_si256((void *)y, _mm256_permute2x128_si256(u, v, 0x20));
    _mm256_storeu_si256((void *)(y + 8), _mm256_permute2x128_si256(u, v, 0x31));
}

#include "kernel/int_tile.h"

const ted4_int_dense ted4_int_dense_avx2 = { hidden, last };

#else
typedef int ted4_int_dense_avx2_is_for_x86_64;
#endif
