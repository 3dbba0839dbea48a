/* rate_exchange.c - see rate_exchange.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "rate_exchange.h"

#include <string.h>

#include "chunk_exchange.h"
#include "view_exchange.h"

/* What travels of a block: gradients of its values, its steps; and of a chunk: its bits. */
typedef struct {
    const ted4_trainer *t;
    ted4_rate_sums *sums;
    const size_t *first;
    size_t gradients, steps, bits; /* floats */
} wave;

static wave make_wave(const ted4_trainer *t, ted4_rate_sums *sums, const size_t *first)
{
    return (wave) { t,
                    sums,
                    first,
                    (size_t)t->layout.n_channels * TED4_LANES,
                    (size_t)TED4_TYPES * TED4_LANES,
                    TED4_TYPES * (sizeof(double) / sizeof(float)) };
}

/* Returns the floats of chunks 0 to chunk - 1. */
static size_t floats_before(const wave *w, size_t chunk)
{
    return (w->first[chunk] - w->first[0]) * (w->gradients + w->steps) + chunk * w->bits;
}

/* Copies a chunk to its place at, or with back from there. */
static void copy_chunk(const wave *w, size_t chunk, float *at, int back)
{
    const ted4_visible_blocks *s = &w->t->visible_blocks;
    double *bits = w->sums[chunk].bits;

    memcpy(back ? (void *)bits : at, back ? at : (void *)bits, w->bits * sizeof *at);
    at += w->bits;
    for (size_t i = w->first[chunk]; i < w->first[chunk + 1]; i++) {
        float *gradient = s->gradient[i], *steps = s->steps[i];

        memcpy(back ? gradient : at, back ? at : gradient, w->gradients * sizeof *at);
        at += w->gradients;
        memcpy(back ? steps : at, back ? at : steps, w->steps * sizeof *at);
        at += w->steps;
    }
}

static int join(void *user, ted4_rate_sums *sums, const size_t *first, size_t n, float *d_nete)
{
    ted4_trainer *t = user;
    ted4_exchange *x = t->exchange;
    const wave w = make_wave(t, sums, first);
    const size_t from = ted4_chunk_first(x, x->rank, n), to = ted4_chunk_first(x, x->rank + 1, n);
    float *all = ted4_view_exchange_memory(&t->work.view_sums, floats_before(&w, n));
    size_t part[TED4_MAX_RANKS + 1];
    const float *d_net[TED4_RATE_WAVE];

    if (all == NULL)
        return -1;
    for (size_t r = 0; r <= x->n; r++)
        part[r] = floats_before(&w, ted4_chunk_first(x, r, n));
    for (size_t k = from; k < to; k++)
        copy_chunk(&w, k, all + floats_before(&w, k), 0);
    ted4_exchange_share(x, all, part);
    for (size_t k = 0; k < n; k++)
        if (k < from || k >= to)
            copy_chunk(&w, k, all + floats_before(&w, k), 1);
    for (size_t k = 0; k < n; k++)
        d_net[k] = sums[k].d_net;
    return ted4_chunk_exchange(x, &t->work.view_sums, d_net, n, t->layout.shape.n_nete, 1, d_nete);
}

ted4_rate_ranks ted4_rate_exchange(ted4_trainer *t)
{
    return (ted4_rate_ranks) { t->exchange->rank, t->exchange->n, t, join };
}
