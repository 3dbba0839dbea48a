/* grad_norm.c - measures and searches gradients (grad_norm.h). Sums over lanes and visible blocks
 * have one order, so that they do not depend on the number of threads.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "grad_norm.h"

#include <math.h>

#include "math/lane_sum.h"
#include "train/state/block_exchange.h"

/* The channels of a term in the anchors' values: the first one, and their number. */
typedef struct {
    int first, n;
} channels;

static channels channels_of(const ted4_layout *l, int term)
{
    if (term == TED4_TERM_MASK)
        return (channels) { l->offset_logit, l->n_channels - l->offset_logit };
    return (channels) { l->first[term], l->first[term] >= 0 ? (int)l->shape.dim[term] : 0 };
}

static float add_up(const float *x)
{
    float sum = 0;

    for (int j = 0; j < TED4_LANES; j++)
        sum += x[j];
    return sum;
}

void ted4_gradients_block(const ted4_layout *l, const float *rate, const float *values,
                          const float *gradient, float *squares)
{
    squares[TED4_BLOCK_TERMS] = 0;
    for (int term = 0; term < TED4_BLOCK_TERMS; term++) {
        const channels at = channels_of(l, term);
        float sum[TED4_LANES] = { 0 }, bad[TED4_LANES] = { 0 };

        for (int c = at.first; c < at.first + at.n; c++) {
            const float *x = values + c * TED4_LANES, *g = gradient + c * TED4_LANES;

            /* 0 times a number is 0 unless the number is infinite or NaN. */
#pragma omp simd
            for (int j = 0; j < TED4_LANES; j++)
                bad[j] += 0.0f * x[j];
            if (!(rate[c] > 0))
                continue;
#pragma omp simd
            for (int j = 0; j < TED4_LANES; j++)
                sum[j] += g[j] * g[j];
        }
        squares[term] = add_up(sum);
        if (add_up(bad) != 0 && squares[TED4_BLOCK_TERMS] == 0)
            squares[TED4_BLOCK_TERMS] = (float)(1 + term);
    }
}

static double squares_of(const float *x, size_t n)
{
    return (double)ted4_lane_dot(n, x, x);
}

double ted4_gradients_norm(const float *x, size_t n)
{
    return sqrt(squares_of(x, n));
}

/* A range of the network array. */
typedef struct {
    size_t first, n;
} range;

/* Fills r with the ranges of the network array that make up term. Returns their number, at most
 * TED4_NETS_R. */
static int ranges_of(const ted4_layout *l, int term, range *r)
{
    const ted4_net_shape *h = &l->shape.hyper;
    int n = 0;

    if (term == TED4_TERM_HEADS || term == TED4_TERM_MOTION)
        for (int i = 0; i < TED4_NETS_R; i++)
            if ((i == TED4_NET_PROJECT || i == TED4_NET_DEFORM) == (term == TED4_TERM_MOTION))
                r[n++] = (range) { l->netr + l->shape.netr[i].first,
                                   ted4_network_size(&l->shape.netr[i]) };
    if (term == TED4_TERM_BANK)
        r[n++] = (range) { l->bank, (size_t)l->shape.n_bank };
    if (term == TED4_TERM_PRIOR)
        r[n++] = (range) { l->nete, l->shape.n_nete };
    if (term == TED4_TERM_STEP) {
        /* In the last layer: rows of weights, then biases, one per type. */
        const size_t in = h->dim[h->n_layers - 1], types = l->shape.n_types;
        const size_t end = l->nete + h->first + ted4_network_size(h);

        r[n++] = (range) { end - l->shape.n_outputs - types * in, types * in };
        r[n++] = (range) { end - types, types };
    }
    return n;
}

/* Returns whether the term is being trained. The weights of the entropy model are not before stage
 * 2, nor when they are integers. */
static int is_learnt(const ted4_trainer *t, int term)
{
    return (term != TED4_TERM_PRIOR && term != TED4_TERM_STEP) ||
           (t->phase.stage2 && !t->phase.integer);
}

void ted4_gradients_gather(const ted4_trainer *t, double *norm)
{
    const ted4_visible_blocks *s = &t->visible_blocks;
    double sum[TED4_BLOCK_TERMS] = { 0 };

    for (size_t i = 0; i < s->n; i++)
        for (int k = 0; k < TED4_BLOCK_TERMS; k++)
            sum[k] += (double)s->squares[i * (TED4_BLOCK_TERMS + 1) + (size_t)k];
    for (int k = 0; k < TED4_BLOCK_TERMS; k++)
        norm[k] = sqrt(sum[k]);
    for (int term = TED4_TERM_HEADS; term <= TED4_TERM_STEP; term++) {
        range r[TED4_NETS_R];
        const int n = is_learnt(t, term) ? ranges_of(&t->layout, term, r) : 0;
        double square = 0;

        for (int k = 0; k < n; k++)
            square += squares_of(t->net.gradient + r[k].first, r[k].n);
        norm[term] = sqrt(square);
    }
}

/* The largest magnitude so far, or the first number that is not finite, and the anchor it belongs
 * to. */
typedef struct {
    float most;
    int64_t at;
    int finite;
} largest;

static void compare(largest *best, float x, int64_t at)
{
    if (!best->finite || (isfinite(x) && !(fabsf(x) > best->most)))
        return;
    *best = (largest) { fabsf(x), at, isfinite(x) };
}

static void search_values(const ted4_trainer *t, int term, largest *best)
{
    const ted4_visible_blocks *s = &t->visible_blocks;
    const channels at = channels_of(&t->layout, term);

    for (size_t i = 0; i < s->n; i++)
        for (int c = at.first; c < at.first + at.n; c++)
            for (size_t j = 0; j < TED4_LANES; j++)
                compare(best, s->gradient[i][(size_t)c * TED4_LANES + j],
                        (int64_t)(s->block[i] * (size_t)TED4_LANES + j));
}

static void search_centres(const ted4_trainer *t, largest *best)
{
    const ted4_visible_blocks *s = &t->visible_blocks;
    const size_t K = t->layout.head.n_offsets;

    for (size_t i = 0; i < s->n; i++)
        for (size_t k = 0; s->drawn[i] < s->awake && k < K * TED4_LANES; k++)
            for (int c = 0; c < 3; c++)
                compare(best, t->work.splat_gradient.mean[c][s->drawn[i] * K * TED4_LANES + k],
                        (int64_t)(s->block[i] * (size_t)TED4_LANES + k % TED4_LANES));
}

int64_t ted4_gradients_anchor(const ted4_trainer *t, int term, int *finite)
{
    largest best = { 0, -1, 1 };
    range r[TED4_NETS_R];

    if (term == TED4_TERM_CENTRE && ted4_blocks_shared(t))
        ted4_block_share_centres(t);
    if (term < TED4_BLOCK_TERMS)
        search_values(t, term, &best);
    else if (term == TED4_TERM_CENTRE)
        search_centres(t, &best);
    else if (term < TED4_TERM_COLOUR)
        for (int k = ranges_of(&t->layout, term, r) - 1; k >= 0; k--)
            for (size_t i = 0; i < r[k].n; i++)
                compare(&best, t->net.gradient[r[k].first + i], -1);
    *finite = best.finite;
    return best.at;
}

/* Returns whether one of these channels of anchor i is not finite in this row. */
static int is_bad(const ted4_trainer *t, ted4_row row, size_t i, channels at)
{
    for (int c = at.first; c < at.first + at.n; c++)
        if (!isfinite(*ted4_anchor_value(&t->anchors, row, i, c)))
            return 1;
    return 0;
}

int64_t ted4_gradients_bad_seen(const ted4_trainer *t, int *term)
{
    const ted4_visible_blocks *s = &t->visible_blocks;

    for (size_t i = 0; i < s->n; i++) {
        const int first = (int)s->squares[i * (TED4_BLOCK_TERMS + 1) + TED4_BLOCK_TERMS] - 1;
        const size_t anchor = s->block[i] * (size_t)TED4_LANES;

        for (size_t j = 0; first >= 0 && j < TED4_LANES; j++)
            if (is_bad(t, TED4_ROW_VALUE, anchor + j, channels_of(&t->layout, first))) {
                *term = first;
                return (int64_t)(anchor + j);
            }
    }
    return -1;
}

int64_t ted4_gradients_bad_value(const ted4_trainer *t, int *term)
{
    for (size_t i = 0; i < t->anchors.n; i++) {
        for (int k = 0; k < TED4_BLOCK_TERMS; k++)
            if (is_bad(t, TED4_ROW_VALUE, i, channels_of(&t->layout, k))) {
                *term = k;
                return (int64_t)i;
            }
        if (is_bad(t, TED4_ROW_POSITION, i, (channels) { 0, 3 })) {
            *term = TED4_TERM_CENTRE;
            return (int64_t)i;
        }
    }
    return -1;
}

int ted4_gradients_bad_network(const ted4_trainer *t)
{
    for (int term = TED4_TERM_HEADS; term < TED4_TERM_PRIOR; term++) {
        range r[TED4_NETS_R];
        const int n = ranges_of(&t->layout, term, r);

        for (int k = 0; k < n; k++)
            for (size_t i = 0; i < r[k].n; i++)
                if (!isfinite(t->net.value[r[k].first + i]))
                    return term;
    }
    return TED4_TERM_PRIOR;
}
