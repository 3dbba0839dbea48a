/* int_dense_avx2.c - twin of norm/int_dense.c for AVX2. Channels are taken in pairs, the two 16-bit inputs of an anchor side by
 * side, so that one vpmaddwd does both products. R-NET-006 keeps every partial sum in 32 bits.
 * SPDX-License-Identifier: BSD-2-Clause */
#if defined(__x86_64__)

#include <immintrin.h>
#include <string.h>
#include "kernel/int_kernel.h"

enum { ROW = TED4_PRIOR_BLOCK, GROUP = 16, MAX_PAIRS = TED4_MAX_WIDTH / 2 };

/* 16 anchors of all channel pairs. Unpacking leaves anchors 0-3 8-11 in lo and 4-7 12-15 in hi; packing puts them back. */
typedef struct {
    __m256i lo, hi;
} pair;

static void interleave(const ted4_int_layer *l, const int16_t *x, pair *p)
{
    for (unsigned i = 0; i < l->in; i += 2) {
        const int16_t *row = x + (size_t)i * ROW;
        const __m256i a = _mm256_loadu_si256((const __m256i *)(const void *)row);
        const __m256i b = i + 1 < l->in
            ? _mm256_loadu_si256((const __m256i *)(const void *)(row + ROW))
            : _mm256_setzero_si256();

        p[i / 2].lo = _mm256_unpacklo_epi16(a, b);
        p[i / 2].hi = _mm256_unpackhi_epi16(a, b);
    }
}

static __m256i weights(const int16_t *w)
{
    int32_t both;

    memcpy(&both, w, sizeof both);
    return _mm256_set1_epi32(both);
}

/* acc = (sum + 2^(r-1)) >> r */
static __m256i shift(__m256i acc, unsigned r)
{
    const __m256i half = _mm256_set1_epi32(r > 0 ? 1 << (r - 1) : 0);

    return _mm256_sra_epi32(_mm256_add_epi32(acc, half),
                            _mm_cvtsi32_si128((int)r));
}

/* Four output units from o on, or fewer at the end: the last unit is then done several times. */
static void four(const ted4_int_layer *l, const pair *p, const unsigned *o,
                 pair *y)
{
    const int16_t *w[4];

    for (int j = 0; j < 4; j++) {
        w[j] = l->w + (size_t)o[j] * l->in_pad;
        y[j].lo = y[j].hi = _mm256_set1_epi32(l->b[o[j]]);
    }
    for (unsigned i = 0; i < l->in_pad / 2; i++) {
        const __m256i lo = p[i].lo, hi = p[i].hi;

        for (int j = 0; j < 4; j++) {
            const __m256i both = weights(w[j] + 2 * i);

            y[j].lo = _mm256_add_epi32(y[j].lo, _mm256_madd_epi16(lo, both));
            y[j].hi = _mm256_add_epi32(y[j].hi, _mm256_madd_epi16(hi, both));
        }
    }
    for (int j = 0; j < 4; j++) {
        y[j].lo = shift(y[j].lo, l->r[o[j]]);
        y[j].hi = shift(y[j].hi, l->r[o[j]]);
    }
}

static void choose_units(const ted4_int_layer *l, unsigned o, unsigned *unit)
{
    for (unsigned j = 0; j < 4; j++)
        unit[j] = o + j < l->out ? o + j : l->out - 1;
}

static void hidden(const ted4_int_layer *l, const int16_t *x, size_t n,
                   int16_t *y)
{
    pair     p[MAX_PAIRS], sum[4];
    unsigned unit[4];

    for (size_t a = 0; a < n; a += GROUP) {
        interleave(l, x + a, p);
        for (unsigned o = 0; o < l->out; o += 4) {
            choose_units(l, o, unit);
            four(l, p, unit, sum);
            for (int j = 0; j < 4; j++) {
                const __m256i v = _mm256_max_epi16(
                    _mm256_packs_epi32(sum[j].lo, sum[j].hi),
                    _mm256_setzero_si256());

                _mm256_storeu_si256(
                    (__m256i *)(void *)(y + (size_t)unit[j] * ROW + a), v);
            }
        }
    }
}

static void last(const ted4_int_layer *l, const int16_t *x, size_t n,
                 int32_t *y)
{
    const __m256i high = _mm256_set1_epi32(TED4_OUTPUT_MAX);
    const __m256i low = _mm256_set1_epi32(-TED4_OUTPUT_MAX);
    pair     p[MAX_PAIRS], sum[4];
    unsigned unit[4];

    for (size_t a = 0; a < n; a += GROUP) {
        interleave(l, x + a, p);
        for (unsigned o = 0; o < l->out; o += 4) {
            choose_units(l, o, unit);
            four(l, p, unit, sum);
            for (int j = 0; j < 4; j++) {
                const __m256i u = _mm256_max_epi32(
                    _mm256_min_epi32(sum[j].lo, high), low);
                const __m256i v = _mm256_max_epi32(
                    _mm256_min_epi32(sum[j].hi, high), low);
                __m256i *to = (__m256i *)(void *)(y + (size_t)unit[j] * ROW
                                                  + a);

                _mm256_storeu_si256(to, _mm256_permute2x128_si256(u, v, 0x20));
                _mm256_storeu_si256(to + 1,
                                    _mm256_permute2x128_si256(u, v, 0x31));
            }
        }
    }
}

const ted4_int_dense ted4_int_dense_avx2 = { hidden, last };

#else
typedef int ted4_int_dense_avx2_is_for_x86_64;
#endif
