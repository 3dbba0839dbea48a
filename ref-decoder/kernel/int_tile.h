/* int_tile.h - the variant of norm/int_dense.c for x86-64, whose instructions multiply pairs of
 * 16-bit numbers and add the two products. Channels are processed in pairs, with the two inputs of
 * an anchor side by side, so that one instruction computes both products; R-NET-006 keeps every
 * partial sum in 32 bits. The including file defines GROUP, the number of anchors per vector of
 * inputs; UNITS, the number of output units that are summed at once; and:
 *     vector                                          the vector type
 *     vector nothing(void), load(const int16_t *x)    zeros; loads GROUP inputs
 *     vector low(vector a, vector b), high(...)       interleave the inputs of two channels, each
 *                                                     for half of the anchors
 *     vector both(const int16_t *w), all(int32_t x)   two weights, or x, repeated
 *     vector dot(vector sum, vector x, vector w)      sum + both products of each anchor
 *     vector shift(vector sum, unsigned r)            (sum + 2^(r-1)) >> r
 *     pair                                            a structure of two vectors, lo and hi
 *     void store_hidden(int16_t *y, pair sum), store_last(int32_t *y, pair sum)
 *                                                     activate or clamp, and store GROUP outputs
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_INT_TILE_H
#define TED4_INT_TILE_H

/* Sums stay in registers only if loops over units are unrolled. */
#if defined(__clang__)
#define TED4_UNROLL _Pragma("clang loop unroll(full)")
#else
#define TED4_UNROLL _Pragma("GCC unroll 8")
#endif

enum { ROW = TED4_PRIOR_BLOCK, MAX_PAIRS = TED4_MAX_WIDTH / 2 };

/* Interleaves the inputs of each pair of channels for GROUP anchors. */
static inline void interleave(const ted4_int_layer *l, const int16_t *x, pair *p)
{
    for (unsigned i = 0; i < l->in; i += 2) {
        const int16_t *row = x + (size_t)i * ROW;
        const vector a = load(row), b = i + 1 < l->in ? load(row + ROW) : nothing();

        p[i / 2].lo = low(a, b);
        p[i / 2].hi = high(a, b);
    }
}

/* Computes n output units from o on. At the end of a layer, the last unit is computed several
 * times. Sets unit[n] to the indices of the units and y[n] to their outputs. ahead: the
 * corresponding inputs of the next block, which are prefetched, or NULL. */
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
            /* Without this, gcc starts all products before it finishes the first one, for which
             * AVX2 has too few registers. */
            __asm__ volatile("" : "+v"(sum[j].lo), "+v"(sum[j].hi));
        }
    }
    TED4_UNROLL
    for (int j = 0; j < n; j++) {
        y[j].lo = shift(sum[j].lo, l->r[unit[j]]);
        y[j].hi = shift(sum[j].hi, l->r[unit[j]]);
    }
}

/* Computes UNITS units, or UNITS / 2 if no more are left. Returns this number, in which the last
 * unit of the layer may count several times. */
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

/* Evaluates one layer. store writes a group of anchors of one output to y[at]. many_blocks: blocks
 * of inputs are contiguous, and the caller processes all of them for a few outputs, then again for
 * the next ones. In that case, the inputs of the next block are prefetched while the first units of
 * this block are summed. They are prefetched a few at a time, because processors stall if many are
 * requested at once. */
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
