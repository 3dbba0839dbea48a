/* int_tile.h - twin of norm/int_dense.c for x86-64 machines, which multiply pairs of 16-bit numbers
 * and add the two products. Channels are taken in pairs, the two inputs of an anchor side by side,
 * so that one instruction does both products; R-NET-006 keeps every partial sum in 32 bits. The
 * file that includes it says how many anchors a vector of inputs has, GROUP, and how many output
 * units are summed at once, UNITS, and defines:
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

/* Sums stay in registers only where loops over units are unrolled. */
#if defined(__clang__)
#define TED4_UNROLL _Pragma("clang loop unroll(full)")
#else
#define TED4_UNROLL _Pragma("GCC unroll 8")
#endif

enum { ROW = TED4_PRIOR_BLOCK, MAX_PAIRS = TED4_MAX_WIDTH / 2 };

/* Inputs of two channels side by side, of GROUP anchors. */
static inline void interleave(const ted4_int_layer *l, const int16_t *x, pair *p)
{
    for (unsigned i = 0; i < l->in; i += 2) {
        const int16_t *row = x + (size_t)i * ROW;
        const vector a = load(row), b = i + 1 < l->in ? load(row + ROW) : nothing();

        p[i / 2].lo = low(a, b);
        p[i / 2].hi = high(a, b);
    }
}

/* n output units from o on; at the end of a layer the last unit is done several times. ahead: the
 * same inputs of the next block, or NULL. */
static inline __attribute__((always_inline)) void units(const ted4_int_layer *l, const pair *p,
                                                        unsigned o, const int n,
                                                        const int16_t *ahead, unsigned *unit,
                                                        pair *y)
{
    const int16_t *w[UNITS];
    pair sum[UNITS];

    TED4_UNROLL
    for (int j = 0; j < n; j++) {
        unit[j] = o + (unsigned)j < l->out ? o + (unsigned)j : l->out - 1;
        w[j] = l->w + (size_t)unit[j] * l->in_pad;
        sum[j].lo = sum[j].hi = all(l->b[unit[j]]);
    }
    for (unsigned i = 0; i < l->in_pad / 2; i++) {
        const vector lo = p[i].lo, hi = p[i].hi;

        if (ahead != NULL) {
            __builtin_prefetch(ahead, 0, 2);
            __builtin_prefetch(ahead + ROW, 0, 2);
            ahead += 2 * ROW;
        }

        TED4_UNROLL
        for (int j = 0; j < n; j++) {
            const vector pair_of = both(w[j] + 2 * i);

            sum[j].lo = dot(sum[j].lo, lo, pair_of);
            sum[j].hi = dot(sum[j].hi, hi, pair_of);
            /* Else gcc begins all products before it ends the first, for which there are too few
             * registers with AVX2. */
            __asm__ volatile("" : "+v"(sum[j].lo), "+v"(sum[j].hi));
        }
    }
    TED4_UNROLL
    for (int j = 0; j < n; j++) {
        y[j].lo = shift(sum[j].lo, l->r[unit[j]]);
        y[j].hi = shift(sum[j].hi, l->r[unit[j]]);
    }
}

/* As many units as are summed at once, or half of them when no more are left. Returns how many, the
 * last ones perhaps several times. */
static inline __attribute__((always_inline)) int next_units(const ted4_int_layer *l, const pair *p,
                                                            unsigned o, const int16_t *ahead,
                                                            unsigned *unit, pair *y)
{
    if (l->out - o > UNITS / 2) {
        units(l, p, o, UNITS, ahead, unit, y);
        return UNITS;
    }
    units(l, p, o, UNITS / 2, ahead, unit, y);
    return UNITS / 2;
}

/* One layer; store puts a group of an output's anchors to y[at]. many_blocks: blocks of inputs lie
 * one behind the other, and the caller comes back to all of them for every few outputs. Then those
 * of the next block are fetched while the first units of this one are summed, a few at a time, as
 * processors wait when many are asked for at once. */
static inline __attribute__((always_inline)) void layer(const ted4_int_layer *l, const int16_t *x,
                                                        size_t n, const int many_blocks,
                                                        void (*store)(void *y, size_t at, pair sum),
                                                        void *y)
{
    const size_t block = (size_t)l->in * ROW;
    pair p[MAX_PAIRS], sum[UNITS];
    unsigned unit[UNITS];

    for (size_t a = 0; a < n; a += GROUP) {
        interleave(l, x + a, p);
        for (unsigned o = 0; o < l->out;) {
            const int16_t *ahead = many_blocks && o == 0 ? x + a + block : NULL;
            const int m = next_units(l, p, o, ahead, unit, sum);

            for (int j = 0; j < m; j++)
                store(y, (size_t)unit[j] * ROW + a, sum[j]);
            o += (unsigned)m;
        }
    }
}

static inline void put_hidden(void *y, size_t at, pair sum)
{
    store_hidden((int16_t *)y + at, sum);
}

static inline void put_last(void *y, size_t at, pair sum)
{
    store_last((int32_t *)y + at, sum);
}

static void hidden(const ted4_int_layer *l, const int16_t *x, size_t n, int16_t *y)
{
    layer(l, x, n, 0, put_hidden, y);
}

static void last(const ted4_int_layer *l, const int16_t *x, size_t n, int32_t *y)
{
    layer(l, x, n, 1, put_last, y);
}

#endif
