/* int_tile.h - twin of norm/int_dense.c for machines that multiply pairs of 16-bit numbers and add
 * the two products. Channels are taken in pairs, the two inputs of an anchor side by side, so that
 * one instruction does both products; R-NET-006 keeps every partial sum in 32 bits. The file that
 * includes it says how many anchors a vector of inputs has, GROUP, and how many output units are
 * summed at once, UNITS, and defines:
 *     vector                                          its type
 *     vector nothing(void), load(const int16_t *x)    zeros; GROUP inputs
 *     vector low(vector a, vector b), high(...)       inputs of two channels side by side: of some
 *                                                     anchors, of the others
 *     vector both(const int16_t *w), all(int32_t x)   a pair of weights, or a number, everywhere
 *     vector dot(vector sum, vector x, vector w)      sum + the two products of each anchor
 *     vector shift(vector sum, unsigned r)            (sum + 2^(r-1)) >> r
 *     pair                                            type of two vectors, lo and hi
 *     void store_hidden(int16_t *y, pair sum), store_last(int32_t *y, pair sum)
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_INT_TILE_H
#define TED4_INT_TILE_H

enum { ROW = TED4_PRIOR_BLOCK, MAX_PAIRS = TED4_MAX_WIDTH / 2 };

/* Inputs of the next block, which follow where the caller has many blocks, are on their way
 * meanwhile: the caller comes back to all of them for every few outputs. */
static inline void interleave(const ted4_int_layer *l, const int16_t *x, pair *p)
{
    for (unsigned i = 0; i < l->in; i += 2) {
        const int16_t *row = x + (size_t)i * ROW;

        __builtin_prefetch(row + (size_t)l->in * ROW, 0, 2);
        __builtin_prefetch(row + (size_t)(l->in + 1) * ROW, 0, 2);

        const vector   a = load(row), b = i + 1 < l->in ? load(row + ROW) : nothing();

        p[i / 2].lo = low(a, b);
        p[i / 2].hi = high(a, b);
    }
}

/* n output units from o on; at the end of a layer the last unit is done several times. */
static inline __attribute__((always_inline)) void
units(const ted4_int_layer *l, const pair *p, unsigned o, const int n, unsigned *unit, pair *y)
{
    const int16_t *w[UNITS];
    pair           sum[UNITS];

#pragma GCC unroll 8
    for (int j = 0; j < n; j++) {
        unit[j] = o + (unsigned)j < l->out ? o + (unsigned)j : l->out - 1;
        w[j] = l->w + (size_t)unit[j] * l->in_pad;
        sum[j].lo = sum[j].hi = all(l->b[unit[j]]);
    }
    for (unsigned i = 0; i < l->in_pad / 2; i++) {
        const vector lo = p[i].lo, hi = p[i].hi;

#pragma GCC unroll 8
        for (int j = 0; j < n; j++) {
            const vector pair_of = both(w[j] + 2 * i);

            sum[j].lo = dot(sum[j].lo, lo, pair_of);
            sum[j].hi = dot(sum[j].hi, hi, pair_of);
        }
    }
#pragma GCC unroll 8
    for (int j = 0; j < n; j++) {
        y[j].lo = shift(sum[j].lo, l->r[unit[j]]);
        y[j].hi = shift(sum[j].hi, l->r[unit[j]]);
    }
}

/* As many units as are summed at once, or half of them when no more are left. Returns how many, the
 * last ones perhaps several times. */
static inline int next_units(const ted4_int_layer *l, const pair *p, unsigned o, unsigned *unit,
                             pair *y)
{
    if (l->out - o > UNITS / 2) {
        units(l, p, o, UNITS, unit, y);
        return UNITS;
    }
    units(l, p, o, UNITS / 2, unit, y);
    return UNITS / 2;
}

static void hidden(const ted4_int_layer *l, const int16_t *x, size_t n, int16_t *y)
{
    pair     p[MAX_PAIRS], sum[UNITS];
    unsigned unit[UNITS];

    for (size_t a = 0; a < n; a += GROUP) {
        interleave(l, x + a, p);
        for (unsigned o = 0; o < l->out;) {
            const int m = next_units(l, p, o, unit, sum);

            for (int j = 0; j < m; j++)
                store_hidden(y + (size_t)unit[j] * ROW + a, sum[j]);
            o += (unsigned)m;
        }
    }
}

static void last(const ted4_int_layer *l, const int16_t *x, size_t n, int32_t *y)
{
    pair     p[MAX_PAIRS], sum[UNITS];
    unsigned unit[UNITS];

    for (size_t a = 0; a < n; a += GROUP) {
        interleave(l, x + a, p);
        for (unsigned o = 0; o < l->out;) {
            const int m = next_units(l, p, o, unit, sum);

            for (int j = 0; j < m; j++)
                store_last(y + (size_t)unit[j] * ROW + a, sum[j]);
            o += (unsigned)m;
        }
    }
}

#endif
