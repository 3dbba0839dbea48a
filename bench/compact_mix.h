/* compact_mix.h - a binary probability mixed from several in the logistic domain, with weights that
 * learn from each symbol. Real numbers: an estimate of what integers would do.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_COMPACT_MIX_H
#define TED4_COMPACT_MIX_H

#include <math.h>
#include <stddef.h>
#include "norm/adaptive.h"

enum { COMPACT_INPUTS = 6 };

typedef struct {
    double weight[COMPACT_INPUTS];
} compact_mixer;

/* One symbol's inputs: given, a probability of 1 that is known, and adaptive ones. */
typedef struct {
    double given; /* 0: none */
    ted4_adaptive *context[COMPACT_INPUTS];
    size_t n; /* adaptive contexts */
} compact_inputs;

static inline double compact_logit(double p)
{
    return log(p / (1 - p));
}

static inline void compact_mixer_init(compact_mixer *m, size_t n, double given)
{
    for (size_t i = 0; i < n; i++)
        for (size_t j = 0; j < COMPACT_INPUTS; j++)
            m[i].weight[j] = j == 0 ? given : 0.2;
}

/* Returns the bits of value, 0 or 1, and learns from it. */
static inline double compact_mix(compact_mixer *m, const compact_inputs *x, int value)
{
    double in[COMPACT_INPUTS] = { 0 }, sum = 0, p;

    in[0] = x->given > 0 ? compact_logit(fmin(fmax(x->given, 1e-4), 1 - 1e-4)) : 0;
    for (size_t i = 0; i < x->n; i++)
        in[i + 1] = compact_logit(x->context[i]->p / 65536.0);
    for (size_t i = 0; i <= x->n; i++)
        sum += m->weight[i] * in[i];
    p = fmin(fmax(1 / (1 + exp(-sum)), 1e-4), 1 - 1e-4);
    for (size_t i = 0; i <= x->n; i++)
        m->weight[i] += 0.005 * (value - p) * in[i];
    for (size_t i = 0; i < x->n; i++)
        ted4_adaptive_update(x->context[i], value);
    return -log2(value ? p : 1 - p);
}

#endif
