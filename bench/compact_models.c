/* compact_models.c - see compact.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "compact.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include "base/bytes.h"
#include "kernel/int_kernel.h"
#include "norm/gaussian.h"
#include "norm/prior.h"

enum { BLOCK = TED4_PRIOR_BLOCK };

#define SQRT_HALF 0.70710678118654752440

void *compact_need(size_t n, size_t size)
{
    void *const p = calloc(n > 0 ? n : 1, size);

    if (p == NULL) {
        fprintf(stderr, "compact: out of memory\n");
        exit(3);
    }
    return p;
}

int compact_coded(const ted4_scene *s, int type, unsigned comp, size_t a)
{
    return type == TED4_PHI      ? s->dynamic[a]
           : type == TED4_OFFSET ? s->offset_bits[a] >> comp / 3 & 1
                                 : 1;
}

double compact_sigma(unsigned index)
{
    return exp2(((double)index - 64) / 16);
}

double compact_step(const ted4_scene *s, int type, size_t a)
{
    return (double)s->head.step[type] * (double)ted4_bits_float(ted4_step[s->step_index[type][a]]);
}

double compact_bits(double probability)
{
    return -log2(fmax(probability, 0x1p-16));
}

double compact_mass(double k, double mu, double sigma)
{
    const double d = fabs(k - mu);

    return 0.5 * (erfc((d - 0.5) / sigma * SQRT_HALF) - erfc((d + 0.5) / sigma * SQRT_HALF));
}

/* Adds what the slice networks say to the outputs of n <= 64 anchors, from the decoded symbols. */
static void add_slices(const ted4_scene *s, const ted4_prior *prior, size_t first, size_t n,
                       int32_t *out)
{
    static int16_t context[TED4_MAX_FEATURE * BLOCK];
    static int32_t added[2 * TED4_MAX_FEATURE * BLOCK];
    const ted4_header *const h = &s->head;
    unsigned comp = h->slice[0];

    for (unsigned i = 0; i < h->feature_dim; i++)
        for (size_t a = 0; a < n; a++)
            context[i * BLOCK + a] =
                ted4_context(s->symbol[TED4_FEATURE][(size_t)i * h->n_anchors + first + a],
                             s->step_index[TED4_FEATURE][first + a], h->context_bits);
    for (unsigned m = 1; m < h->n_slices; comp += h->slice[m++]) {
        int32_t *const mu = out + (size_t)comp * BLOCK;
        int32_t *const sigma = mu + (size_t)h->feature_dim * BLOCK;

        ted4_prior_slice(prior, m, context, n, added);
        for (unsigned i = 0; i < h->slice[m]; i++)
            for (size_t a = 0; a < n; a++) {
                mu[i * BLOCK + a] += added[i * BLOCK + a];
                sigma[i * BLOCK + a] += added[(h->slice[m] + i) * BLOCK + a];
            }
    }
}

static void keep_block(compact_models *m, size_t first, size_t n, const int32_t *out)
{
    const ted4_shape *const shape = &m->s->shape;

    for (int t = 0; t < TED4_TYPES; t++)
        for (unsigned c = 0; c < shape->dim[t]; c++)
            for (size_t a = 0; a < n; a++) {
                const size_t at = (size_t)(shape->first_output[t] + c) * BLOCK + a;
                const size_t to = (size_t)c * m->n + first + a;

                m->mu[t][to] = out[at];
                m->sigma[t][to] = ted4_sigma_index(out[at + (size_t)shape->dim[t] * BLOCK]);
            }
}

void compact_models_make(compact_models *m, const ted4_scene *s)
{
    int32_t *const out = compact_need((size_t)s->shape.n_outputs * BLOCK, sizeof *out);
    ted4_arena arena;
    ted4_prior prior;

    *m = (compact_models) { .s = s, .n = s->head.n_anchors };
    for (int t = 0; t < TED4_TYPES; t++) {
        m->mu[t] = compact_need(s->shape.dim[t] * m->n, sizeof *m->mu[t]);
        m->sigma[t] = compact_need(s->shape.dim[t] * m->n, 1);
    }
    ted4_arena_init(&arena, NULL);
    if (ted4_prior_init(&prior, &s->head, &s->shape, &arena) != TED4_OK ||
        ted4_prior_load(&prior, s->nete.values, s->shift, NULL) != TED4_OK) {
        fprintf(stderr, "compact: networks cannot be loaded\n");
        exit(3);
    }
    prior.dense = ted4_select_int_dense();
    for (size_t a = 0; a < m->n; a += BLOCK) {
        const size_t n = m->n - a < BLOCK ? m->n - a : BLOCK;

        ted4_prior_hyper(&prior, s->position + 3 * a, n, out);
        add_slices(s, &prior, a, n, out);
        keep_block(m, a, n, out);
    }
    ted4_arena_finish(&arena);
    free(out);
}

void compact_models_free(compact_models *m)
{
    for (int t = 0; t < TED4_TYPES; t++) {
        free(m->mu[t]);
        free(m->sigma[t]);
    }
}
