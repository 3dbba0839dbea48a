/* int_dense.c - spec 7.3 "Evaluation": dense layers in integer arithmetic, in portable C. The
 * faster variants are in kernel/. R-NET-006 ensures that no sum overflows, in any order of
 * summation. SPDX-License-Identifier: BSD-2-Clause */
#include "norm/prior.h"

/* Computes the sums of output unit o for n columns. */
static void accumulate(const ted4_int_layer *l, unsigned o, const int16_t *x, size_t n,
                       int32_t *acc)
{
    const int16_t *w = l->w + (size_t)o * l->in_pad;

    for (size_t a = 0; a < n; a++)
        acc[a] = l->b[o];
    for (unsigned i = 0; i < l->in; i++) {
        const int16_t *row = x + (size_t)i * TED4_PRIOR_BLOCK;

        for (size_t a = 0; a < n; a++)
            acc[a] += w[i] * row[a];
    }
}

static void hidden(const ted4_int_layer *l, const int16_t *x, size_t n, int16_t *y)
{
    int32_t acc[TED4_PRIOR_BLOCK];

    for (unsigned o = 0; o < l->out; o++, y += TED4_PRIOR_BLOCK) {
        accumulate(l, o, x, n, acc);
        for (size_t a = 0; a < n; a++)
            y[a] = (int16_t)ted4_clamp(ted4_round_shift(acc[a], l->r[o]), 0, 32767);
    }
}

static void last(const ted4_int_layer *l, const int16_t *x, size_t n, int32_t *y)
{
    int32_t acc[TED4_PRIOR_BLOCK];

    for (unsigned o = 0; o < l->out; o++, y += TED4_PRIOR_BLOCK) {
        accumulate(l, o, x, n, acc);
        for (size_t a = 0; a < n; a++)
            y[a] = ted4_clamp(ted4_round_shift(acc[a], l->r[o]), -TED4_OUTPUT_MAX, TED4_OUTPUT_MAX);
    }
}

const ted4_int_dense ted4_int_dense_plain = { hidden, last };
