/* gauss_many_avx512.c - instantiates gauss_tile.h for AVX-512, with two vectors of sixteen lanes.
 * Substreams of fewer than 32 lanes are passed to the AVX2 variant.
 * SPDX-License-Identifier: BSD-2-Clause */
#if defined(__x86_64__)

#include <immintrin.h>

#define VECTOR 64
#include "kernel/gauss_vector.h"
#include "norm/tables.h"

typedef __mmask16 mask;

static inline vi all(int32_t x)
{
    return (vi)_mm512_set1_epi32(x);
}

static inline vi least(vi a, vi b)
{
    return (vi)_mm512_min_epi32((__m512i)a, (__m512i)b);
}

static inline vi most(vi a, vi b)
{
    return (vi)_mm512_max_epi32((__m512i)a, (__m512i)b);
}

static inline mask less(vi a, vi b)
{
    return _mm512_cmplt_epi32_mask((__m512i)a, (__m512i)b);
}

static inline mask equal(vi a, vi b)
{
    return _mm512_cmpeq_epi32_mask((__m512i)a, (__m512i)b);
}

static inline mask either(mask a, mask b)
{
    return (mask)(a | b);
}

static inline mask lanes_of(unsigned bits)
{
    return (mask)bits;
}

static inline unsigned bits_of(mask m)
{
    return m;
}

static inline vi choose(mask m, vi yes, vi no)
{
    return (vi)_mm512_mask_mov_epi32((__m512i)no, m, (__m512i)yes);
}

/* Table entries are loaded one by one: gather instructions take several times as long on processors
 * whose microcode mitigates data leaks through them. */
static inline __m128i two_pairs(const int32_t *table, const uint32_t *i)
{
    const __m128 first = _mm_castsi128_ps(_mm_loadl_epi64((const void *)(table + i[0])));

    return _mm_castps_si128(_mm_loadh_pi(first, (const void *)(table + i[1])));
}

static inline __m256i four_pairs(const int32_t *table, const uint32_t *i)
{
    return _mm256_set_m128i(two_pairs(table, i + 2), two_pairs(table, i));
}

/* The indices are stored to memory and loaded from there, which is faster than extracting each from
 * the vector. The empty assembly makes the compiler assume that i has changed; otherwise it would
 * extract them. */
static inline void pairs(const int32_t *table, vi index, vi *low, vi *high)
{
    _Alignas(VECTOR) uint32_t i[LANES];

    _mm512_store_si512((void *)i, (__m512i)index);
    __asm__("" : "+m"(i));

    const __m512i a = _mm512_inserti64x4(_mm512_castsi256_si512(four_pairs(table, i)),
                                         four_pairs(table, i + 4), 1);
    const __m512i b = _mm512_inserti64x4(_mm512_castsi256_si512(four_pairs(table, i + 8)),
                                         four_pairs(table, i + 12), 1);
    const __m512i even =
        _mm512_setr_epi32(0, 2, 4, 6, 8, 10, 12, 14, 16, 18, 20, 22, 24, 26, 28, 30);

    *low = (vi)_mm512_permutex2var_epi32(a, even, b);
    *high = (vi)_mm512_permutex2var_epi32(a, _mm512_add_epi32(even, _mm512_set1_epi32(1)), b);
}

static inline vi indices(const uint8_t *sigma)
{
    return (vi)_mm512_cvtepu8_epi32(_mm_loadu_si128((const void *)sigma));
}

static inline vi scales(vi sigma)
{
    const __m512i even =
        _mm512_setr_epi32(0, 2, 4, 6, 8, 10, 12, 14, 16, 18, 20, 22, 24, 26, 28, 30);
    const __m512i near = _mm512_loadu_si512((const void *)(ted4_stepi + 128)),
                  far = _mm512_loadu_si512((const void *)(ted4_stepi + 144));

    return (vi)_mm512_permutexvar_epi32((__m512i)sigma, _mm512_permutex2var_epi32(near, even, far));
}

static inline vi expand(unsigned wants, const uint8_t *words)
{
    return (vi)_mm512_maskz_expand_epi32(
        (mask)wants, _mm512_cvtepu16_epi32(_mm256_loadu_si256((const void *)words)));
}

static inline void narrow(int16_t *to, vi x)
{
    _mm256_storeu_si256((void *)to, _mm512_cvtepi32_epi16((__m512i)x));
}

#include "kernel/gauss_tile.h"

size_t ted4_gauss_many_avx512(ted4_gauss_lanes *d, size_t n, const int32_t *mu,
                              const uint8_t *sigma, int16_t *k)
{
    if (d->n_lanes < 2 * LANES)
        return ted4_gauss_many_avx2(d, n, mu, sigma, k);
    return many_rows(d, 2, n, mu, sigma, k);
}

#else
typedef int ted4_gauss_many_avx512_is_for_x86_64;
#endif
