/* loss_terms.c - volume, bank and rate terms of the loss: see loss_terms.h. Source: paper,
 * "Training Objectives"; annex D.1.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "loss_terms.h"

#include <math.h>

#include "math/lane_sum.h"
#include "train/state/block_exchange.h"
#include "train/state/rate_exchange.h"
#include "train/monitor/monitor.h"
#include "train/math/random.h"

/* Gaussians are divided into PARTS parts for any number of threads, and sums over them are taken in
 * COLUMNS columns for any vector size, so that the order of additions is always the same. */
enum { PARTS = 64, COLUMNS = 16 };

typedef struct {
    const ted4_splat_grads *g;
    const ted4_splats *s;
    float weight; /* of one Gaussian's volume */
    size_t visible[PARTS], drawn[PARTS];
    double squares[PARTS]; /* sums of squares of the gradients of centres */
} screen_job;

static size_t first_of(const screen_job *j, size_t part)
{
    const size_t rows = (j->s->n + COLUMNS - 1) / COLUMNS, at = rows * part / PARTS * COLUMNS;

    return at < j->s->n ? at : j->s->n;
}

static void count_part(void *arg, size_t part)
{
    screen_job *j = arg;
    const size_t first = first_of(j, part), n = first_of(j, part + 1) - first;
    unsigned visible = 0;

#pragma omp simd reduction(+ : visible)
    for (size_t i = first; i < first + n; i++)
        visible += j->g->visible[i];
    j->visible[part] = visible;
    j->squares[part] = 0;
    for (int c = 0; c < 3; c++)
        j->squares[part] += (double)ted4_lane_dot(n, j->g->mean[c] + first, j->g->mean[c] + first);
}

static void volume_part(void *arg, size_t part)
{
    screen_job *j = arg;
    const ted4_splat_grads *g = j->g;
    const ted4_splats *s = j->s;
    const size_t end = first_of(j, part + 1);
    unsigned drawn = 0;

#pragma omp simd reduction(+ : drawn)
    for (size_t i = first_of(j, part); i < end; i++) {
        const float on = j->weight * (float)g->visible[i];
        const float a = s->scale[0][i], b = s->scale[1][i], c = s->scale[2][i];

        g->scale[0][i] += on * b * c;
        g->scale[1][i] += on * a * c;
        g->scale[2][i] += on * a * b;
        drawn += a >= TED4_NO_EXTENT || b >= TED4_NO_EXTENT || c >= TED4_NO_EXTENT ? g->visible[i]
                                                                                   : 0u;
    }
    j->drawn[part] = drawn;
}

size_t ted4_update_volume(ted4_trainer *t, const ted4_splats *s)
{
    screen_job j = { .g = &t->work.splat_gradient, .s = s };
    size_t n = 0, drawn = 0;
    double squares = 0;

    ted4_parallel_for(t->parallel, PARTS, count_part, &j);
    for (int part = 0; part < PARTS; part++) {
        n += j.visible[part];
        squares += j.squares[part];
    }
    j.weight = n > 0 ? (float)(t->opt.volume_weight / (double)n) : 0.0f;
    ted4_parallel_for(t->parallel, PARTS, volume_part, &j);
    for (int part = 0; part < PARTS; part++)
        drawn += j.drawn[part];
    t->monitor.norm[TED4_TERM_CENTRE] = sqrt(squares);
    t->monitor.drawn = (double)drawn;
    return n;
}

void ted4_update_bank(ted4_trainer *t)
{
    const ted4_header *h = &t->layout.head;
    const size_t D = h->bank_dim, M = h->bank_rows;
    const float *z = t->net.value + t->layout.bank;
    float *d = t->net.gradient + t->layout.bank;

    if (M < 3)
        return;

    const float w = (float)(2.0 * t->opt.tv_weight / ((double)(M - 2) * (double)D));

    for (size_t i = 0; i + 2 < M; i++)
        for (size_t c = 0; c < D; c++) {
            const float e = z[i * D + c] - 2.0f * z[(i + 1) * D + c] + z[(i + 2) * D + c];

            d[i * D + c] += w * e;
            d[(i + 1) * D + c] -= 2.0f * w * e;
            d[(i + 2) * D + c] += w * e;
        }
}

/* One swap of a partial shuffle: after m swaps, the first m visible blocks are a uniform random
 * choice. The order of the others does not matter. */
static void swap_blocks(ted4_visible_blocks *s, size_t i, size_t k)
{
    const uint32_t block = s->block[i], lanes = s->lanes[i], drawn = s->drawn[i];
    const float *position = s->position[i], *raw = s->raw[i], *used = s->used[i];
    float *gradient = s->gradient[i], *steps = s->steps[i];

    s->block[i] = s->block[k];
    s->lanes[i] = s->lanes[k];
    s->drawn[i] = s->drawn[k];
    s->position[i] = s->position[k];
    s->raw[i] = s->raw[k];
    s->used[i] = s->used[k];
    s->gradient[i] = s->gradient[k];
    s->steps[i] = s->steps[k];
    s->block[k] = block;
    s->lanes[k] = lanes;
    s->drawn[k] = drawn;
    s->position[k] = position;
    s->raw[k] = raw;
    s->used[k] = used;
    s->gradient[k] = gradient;
    s->steps[k] = steps;
}

int ted4_update_rate(ted4_trainer *t, uint64_t key)
{
    ted4_visible_blocks *s = &t->visible_blocks;
    const size_t want = (size_t)ceil(t->opt.rate_share * (double)s->n);
    const size_t m = want < s->n ? want : s->n;
    const double params = ted4_rate_norm(t);
    double bits[TED4_TYPES], chosen = 0;

    for (size_t i = 0; i < m; i++)
        swap_blocks(s, i, i + ted4_below(key, i, (uint32_t)(s->n - i)));
    for (size_t i = 0; i < m; i++)
        for (uint32_t x = s->lanes[i]; x != 0; x &= x - 1)
            chosen += 1;

    ted4_rate_input in = { &t->layout,
                           t->net.value,
                           t->net.shift,
                           m,
                           s->raw,
                           s->position,
                           s->lanes,
                           s->block,
                           key,
                           t->phase.integer ? TED4_QUANT_INTEGER : TED4_QUANT_NOISE,
                           (float)(t->opt.lambda / (fmax(chosen, 1) * params)),
                           (float)((double)s->n / (double)m),
                           t->layout.head.activation,
                           NULL };
    ted4_rate_ranks ranks;

    if (ted4_blocks_shared(t)) {
        ranks = ted4_rate_exchange(t);
        in.ranks = &ranks;
    }
    if (!t->phase.integer)
        ted4_rate_pack(t->work.rate, t->net.value);
    if (m > 0 &&
        ted4_rate_evaluate(t->work.rate, &in, t->parallel, (const float *const *)s->gradient,
                           s->gradient, t->net.gradient, s->steps, bits) != 0)
        return ted4_trainer_fail(t, "no memory for the rate model");
    for (int y = 0; y < TED4_TYPES && chosen > 0; y++)
        t->progress.bits[y] += 0.02 * (bits[y] / chosen - t->progress.bits[y]);
    return 0;
}
