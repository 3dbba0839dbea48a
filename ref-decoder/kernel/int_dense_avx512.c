/* int_dense_avx512.c - twin of norm/int_dense.c for AVX-512. Channels are taken in pairs, the two 16-bit inputs of an anchor side
 * by side, so that one vpmaddwd does both products. R-NET-006 keeps every partial sum in 32 bits.
 * SPDX-License-Identifier: BSD-2-Clause */
#if defined(__x86_64__)

#include <immintrin.h>
#include <string.h>
#include "kernel/int_kernel.h"

enum { ROW = TED4_PRIOR_BLOCK, GROUP = 32, MAX_PAIRS = TED4_MAX_WIDTH / 2,
       UNITS = 8 };

/* 32 anchors of all channel pairs. Of each eight anchors the first four are in lo, the others in hi; packing puts them back. */
typedef struct {
    __m512i lo, hi;
} pair;

static void interleave(const ted4_int_layer *l, const int16_t *x, pair *p)
{
    for (unsigned i = 0; i < l->in; i += 2) {
        const int16_t *row = x + (size_t)i * ROW;
        const __m512i a = _mm512_loadu_si512((const void *)row);
        const __m512i b = i + 1 < l->in
                        ? _mm512_loadu_si512((const void *)(row + ROW))
                        : _mm512_setzero_si512();

        p[i / 2].lo = _mm512_unpacklo_epi16(a, b);
        p[i / 2].hi = _mm512_unpackhi_epi16(a, b);
    }
}

static __m512i weights(const int16_t *w)
{
    int32_t both;

    memcpy(&both, w, sizeof both);
    return _mm512_set1_epi32(both);
}

/* (sum + 2^(r-1)) >> r */
static __m512i shift(__m512i acc, unsigned r)
{
    const __m512i half = _mm512_set1_epi32(r > 0 ? 1 << (r - 1) : 0);

    return _mm512_sra_epi32(_mm512_add_epi32(acc, half),
                            _mm_cvtsi32_si128((int)r));
}

/* UNITS output units; at the end of a layer the last unit is done several times. */
static void choose_units(const ted4_int_layer *l, unsigned o, unsigned *unit)
{
    for (unsigned j = 0; j < UNITS; j++)
        unit[j] = o + j < l->out ? o + j : l->out - 1;
}

static void evaluate(const ted4_int_layer *l, const pair *p,
                     const unsigned *unit, pair *y)
{
    const int16_t *w[UNITS];
    pair sum[UNITS];

#pragma GCC unroll 8
    for (int j = 0; j < UNITS; j++) {
        w[j] = l->w + (size_t)unit[j] * l->in_pad;
        sum[j].lo = sum[j].hi = _mm512_set1_epi32(l->b[unit[j]]);
    }
    for (unsigned i = 0; i < l->in_pad / 2; i++) {
        const __m512i lo = p[i].lo, hi = p[i].hi;

#pragma GCC unroll 8
        for (int j = 0; j < UNITS; j++) {
            const __m512i both = weights(w[j] + 2 * i);

            sum[j].lo = _mm512_add_epi32(sum[j].lo,
                                         _mm512_madd_epi16(lo, both));
            sum[j].hi = _mm512_add_epi32(sum[j].hi,
                                         _mm512_madd_epi16(hi, both));
        }
    }
#pragma GCC unroll 8
    for (int j = 0; j < UNITS; j++) {
        y[j].lo = shift(sum[j].lo, l->r[unit[j]]);
        y[j].hi = shift(sum[j].hi, l->r[unit[j]]);
    }
}

static void hidden(const ted4_int_layer *l, const int16_t *x, size_t n,
                   int16_t *y)
{
    pair     p[MAX_PAIRS], sum[UNITS];
    unsigned unit[UNITS];

    for (size_t a = 0; a < n; a += GROUP) {
        interleave(l, x + a, p);
        for (unsigned o = 0; o < l->out; o += UNITS) {
            choose_units(l, o, unit);
            evaluate(l, p, unit, sum);
            for (int j = 0; j < UNITS; j++)
                _mm512_storeu_si512(
                    (void *)(y + (size_t)unit[j] * ROW + a),
                    _mm512_max_epi16(_mm512_packs_epi32(sum[j].lo, sum[j].hi),
                                     _mm512_setzero_si512()));
        }
    }
}

/* Two vectors of 16 anchors in order, from lo and hi. */
static void store_last(pair v, int32_t *to)
{
    const __m512i high = _mm512_set1_epi32(TED4_OUTPUT_MAX);
    const __m512i low = _mm512_set1_epi32(-TED4_OUTPUT_MAX);
    const __m512i first = _mm512_setr_epi64(0, 1, 8, 9, 2, 3, 10, 11);
    const __m512i second = _mm512_setr_epi64(4, 5, 12, 13, 6, 7, 14, 15);

    v.lo = _mm512_max_epi32(_mm512_min_epi32(v.lo, high), low);
    v.hi = _mm512_max_epi32(_mm512_min_epi32(v.hi, high), low);
    _mm512_storeu_si512((void *)to,
                        _mm512_permutex2var_epi64(v.lo, first, v.hi));
    _mm512_storeu_si512((void *)(to + 16),
                        _mm512_permutex2var_epi64(v.lo, second, v.hi));
}

static void last(const ted4_int_layer *l, const int16_t *x, size_t n,
                 int32_t *y)
{
    pair     p[MAX_PAIRS], sum[UNITS];
    unsigned unit[UNITS];

    for (size_t a = 0; a < n; a += GROUP) {
        interleave(l, x + a, p);
        for (unsigned o = 0; o < l->out; o += UNITS) {
            choose_units(l, o, unit);
            evaluate(l, p, unit, sum);
            for (int j = 0; j < UNITS; j++)
                store_last(sum[j], y + (size_t)unit[j] * ROW + a);
        }
    }
}

const ted4_int_dense ted4_int_dense_avx512 = { hidden, last };

#else
typedef int ted4_int_dense_avx512_is_for_x86_64;
#endif
