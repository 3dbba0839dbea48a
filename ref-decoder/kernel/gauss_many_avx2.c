/* gauss_many_avx2.c - instantiates gauss_tile.h for AVX2, with vectors of eight lanes.
 * SPDX-License-Identifier: BSD-2-Clause */
#if defined(__x86_64__)

#include <immintrin.h>

#define VECTOR 32
#include "kernel/gauss_vector.h"
#include "kernel/word_places.h"
#include "norm/tables.h"

typedef vi mask; /* per lane: all bits set, or none */

static inline vi all(int32_t x)
{
    return (vi)_mm256_set1_epi32(x);
}

static inline vi least(vi a, vi b)
{
    return (vi)_mm256_min_epi32((__m256i)a, (__m256i)b);
}

static inline vi most(vi a, vi b)
{
    return (vi)_mm256_max_epi32((__m256i)a, (__m256i)b);
}

static inline mask less(vi a, vi b)
{
    return (vi)_mm256_cmpgt_epi32((__m256i)b, (__m256i)a);
}

static inline mask equal(vi a, vi b)
{
    return (vi)_mm256_cmpeq_epi32((__m256i)a, (__m256i)b);
}

static inline mask either(mask a, mask b)
{
    return a | b;
}

static inline mask lanes_of(unsigned bits)
{
    const vi bit = { 1, 2, 4, 8, 16, 32, 64, 128 };

    return equal(all((int32_t)bits) & bit, bit);
}

static inline unsigned bits_of(mask m)
{
    return (unsigned)_mm256_movemask_ps(_mm256_castsi256_ps((__m256i)m));
}

static inline vi choose(mask m, vi yes, vi no)
{
    return (vi)_mm256_castps_si256(_mm256_blendv_ps(_mm256_castsi256_ps((__m256i)no),
                                                    _mm256_castsi256_ps((__m256i)yes),
                                                    _mm256_castsi256_ps((__m256i)m)));
}

/* Table entries are loaded one by one: gather instructions take several times as long on processors
 * whose microcode mitigates data leaks through them. */
static inline __m128i two_pairs(const int32_t *table, uint32_t i, uint32_t j)
{
    const __m128 first = _mm_castsi128_ps(_mm_loadl_epi64((const void *)(table + i)));

    return _mm_castps_si128(_mm_loadh_pi(first, (const void *)(table + j)));
}

/* The indices are stored to memory and loaded from there, which is faster than extracting each from
 * the vector. The empty assembly makes the compiler assume that i has changed; otherwise it would
 * extract them. */
static inline void pairs(const int32_t *table, vi index, vi *low, vi *high)
{
    _Alignas(VECTOR) uint32_t i[LANES];

    _mm256_store_si256((void *)i, (__m256i)index);
    __asm__("" : "+m"(i));

    const __m256i a = _mm256_set_m128i(two_pairs(table, i[4], i[5]), two_pairs(table, i[0], i[1]));
    const __m256i b = _mm256_set_m128i(two_pairs(table, i[6], i[7]), two_pairs(table, i[2], i[3]));
    const __m256 x = _mm256_castsi256_ps(a), y = _mm256_castsi256_ps(b);

    *low = (vi)_mm256_castps_si256(_mm256_shuffle_ps(x, y, 0x88));
    *high = (vi)_mm256_castps_si256(_mm256_shuffle_ps(x, y, 0xdd));
}

static inline vi indices(const uint8_t *sigma)
{
    return (vi)_mm256_cvtepu8_epi32(_mm_loadl_epi64((const void *)sigma));
}

static inline vi scales(vi sigma)
{
    const int32_t *step = ted4_stepi + 128;
    const __m256i near = _mm256_setr_epi32(step[0], step[2], step[4], step[6], step[8], step[10],
                                           step[12], step[14]);
    const __m256i far = _mm256_setr_epi32(step[16], step[18], step[20], step[22], step[24],
                                          step[26], step[28], step[30]);
    const __m256 a = _mm256_castsi256_ps(_mm256_permutevar8x32_epi32(near, (__m256i)sigma));
    const __m256 b = _mm256_castsi256_ps(_mm256_permutevar8x32_epi32(far, (__m256i)sigma));

    return (vi)_mm256_castps_si256(
        _mm256_blendv_ps(a, b, _mm256_castsi256_ps((__m256i)(sigma << 28))));
}

static inline __m128i expand_four(unsigned wants, const uint8_t *words)
{
    return _mm_shuffle_epi8(_mm_loadl_epi64((const void *)words),
                            _mm_load_si128((const void *)ted4_word_places[wants]));
}

static inline vi expand(unsigned wants, const uint8_t *words)
{
    const unsigned first = wants & 15;

    return (vi)_mm256_set_m128i(expand_four(wants >> 4, words + 2 * __builtin_popcount(first)),
                                expand_four(first, words));
}

static inline void narrow(int16_t *to, vi x)
{
    const __m256i low = _mm256_shuffle_epi8(
        (__m256i)x, _mm256_setr_epi8(0, 1, 4, 5, 8, 9, 12, 13, -1, -1, -1, -1, -1, -1, -1, -1, 0, 1,
                                     4, 5, 8, 9, 12, 13, -1, -1, -1, -1, -1, -1, -1, -1));

    _mm_storeu_si128((void *)to, _mm256_castsi256_si128(_mm256_permute4x64_epi64(low, 0x08)));
}

#include "kernel/gauss_tile.h"

size_t ted4_gauss_many_avx2(ted4_gauss_lanes *d, size_t n, const int32_t *mu, const uint8_t *sigma,
                            int16_t *k)
{
    return many(d, n, mu, sigma, k);
}

#else
typedef int ted4_gauss_many_avx2_is_for_x86_64;
#endif
