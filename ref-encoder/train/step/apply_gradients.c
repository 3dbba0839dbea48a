/* apply_gradients.c - see apply_gradients.h. Source: paper, "Training Objectives"; annex D.1.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "apply_gradients.h"

#include <math.h>

#include "train/monitor/grad_norm.h"
#include "recon/strict.h"
#include "schedule.h"
#include "settle_positions.h"
#include "train/math/adam.h"

/* The largest number of channels that the ranges of the header allow (model.h). */
enum { MAX_CHANNELS = TED4_MAX_FEATURE + 6 + 4 * TED4_MAX_OFFSETS + TED4_MAX_PHI + 4 + 1 };

/* Weights of networks that one job updates. */
enum { NET_PIECE = 2048 };

typedef struct {
    ted4_trainer *t;
    float rate[MAX_CHANNELS];
    ted4_adam_bias bias;
    float mask_weight, temporal_weight;
    ted4_net_range range[TED4_NET_RANGES];
    size_t n_pieces; /* pieces of all ranges; these are the first jobs, before the visible blocks */
} update_job;

/* Adds weight times the derivative of sigmoid(logit), for the anchors of visible block i. */
static void add_mask_loss(const update_job *j, size_t i, int channel, int n, float weight)
{
    const ted4_visible_blocks *s = &j->t->visible_blocks;

    for (int c = channel; c < channel + n; c++) {
        const float *x = s->raw[i] + c * TED4_LANES;
        float *d = s->gradient[i] + c * TED4_LANES;
        const uint32_t lanes = s->lanes[i];

#pragma omp simd
        for (int k = 0; k < TED4_LANES; k++) {
            const float m = ted4_sigmoid(x[k]);
            const float on = (float)(int32_t)(lanes >> k & 1);

            d[k] += on * weight * m * (1.0f - m);
        }
    }
}

static void update_block(const update_job *j, size_t i)
{
    ted4_trainer *t = j->t;
    const ted4_visible_blocks *s = &t->visible_blocks;
    const ted4_layout *l = &t->layout;
    float *x = ted4_block(&t->anchors, TED4_ROW_VALUE, s->block[i]);
    float *m = ted4_block(&t->anchors, TED4_ROW_M, s->block[i]);
    float *v = ted4_block(&t->anchors, TED4_ROW_V, s->block[i]);

    if (j->mask_weight > 0)
        add_mask_loss(j, i, l->offset_logit, l->head.n_offsets, j->mask_weight);
    if (j->temporal_weight > 0)
        add_mask_loss(j, i, l->temporal_logit, 1, j->temporal_weight);
    ted4_gradients_block(l, j->rate, x, s->gradient[i], s->squares + i * (TED4_BLOCK_TERMS + 1));
    for (int c = 0; c < l->n_channels; c++) {
        const size_t at = (size_t)c * TED4_LANES;

        if (j->rate[c] > 0)
            ted4_adam(x + at, m + at, v + at, s->gradient[i] + at, TED4_LANES, j->rate[c], j->bias);
    }
}

static size_t pieces_of(const ted4_net_range *r)
{
    return r->rate > 0 ? (r->n + NET_PIECE - 1) / NET_PIECE : 0;
}

static void update_piece(const update_job *j, size_t piece)
{
    const ted4_trainer *t = j->t;
    const ted4_net_range *r = j->range;

    for (; piece >= pieces_of(r); r++)
        piece -= pieces_of(r);

    const size_t left = r->n - piece * NET_PIECE, at = r->first + piece * NET_PIECE;

    ted4_adam(t->net.value + at, t->net.m + at, t->net.v + at, t->net.gradient + at,
              left < NET_PIECE ? left : NET_PIECE, r->rate, j->bias);
}

static void update_item(void *arg, size_t i)
{
    const update_job *j = arg;

    if (i < j->n_pieces)
        update_piece(j, i);
    else
        update_block(j, i - j->n_pieces);
}

/* Returns how many Gaussians the anchors that this step sees keep; at least one for each, so that
 * the weight of masks cannot grow without end while all of them close. */
static double count_kept(const ted4_trainer *t)
{
    const ted4_visible_blocks *s = &t->visible_blocks;
    const size_t n = ted4_row_floats(t->layout.head.n_offsets);
    uint64_t kept = 0, seen = 0;

    for (size_t i = 0; i < s->n; i++) {
        const float *x = s->raw[i] + ted4_row_floats((size_t)t->layout.offset_logit);

        for (size_t j = 0; j < n; j++)
            kept += (s->lanes[i] >> j % TED4_LANES & 1) && ted4_mask_on(x[j]);
        for (uint32_t left = s->lanes[i]; left != 0; left &= left - 1)
            seen++;
    }
    return (double)(kept > seen ? kept : seen);
}

/* Returns the weight of one offset mask in the loss: option mask_weight times the rate term of what
 * a Gaussian costs on average, which is its part of all bits of its anchor. This cost is a running
 * mean, and the same for all, because masks need a gradient in every step: the bits of single
 * offsets are known only in the steps that evaluate their rate, and Adam would divide such bursts
 * by the root of their mean square. As for the rate itself, the seen anchors stand for all: those
 * that are seen rarely have a larger weight when they are. */
static float offset_mask_weight(const ted4_trainer *t)
{
    double bits = ted4_anchor_bits(t); /* of an anchor */

    for (int y = 0; y < TED4_TYPES; y++)
        bits += t->progress.bits[y];
    return (float)(t->opt.lambda * t->opt.mask_weight * bits /
                   (ted4_rate_norm(t) * fmax(count_kept(t), 1.0)));
}

void ted4_update_parameters(ted4_trainer *t, size_t n_views)
{
    const ted4_header *h = &t->layout.head;
    const uint64_t count = t->iteration - (t->phase.stage2 ? t->phase.stage2_start : 0) + 1;
    const double n = (double)t->anchors.n;
    const float more = sqrtf((float)n_views);
    update_job j = { .t = t, .bias = ted4_adam_bias_make(count) };

    ted4_schedule_rates(t, j.rate);
    for (int c = 0; c < t->layout.n_channels; c++)
        j.rate[c] *= more;
    if (t->phase.stage2 && h->offset_mask)
        j.mask_weight = offset_mask_weight(t);
    if (h->motion != TED4_MOTION_NONE && h->temporal_mask)
        j.temporal_weight = (float)(t->opt.temporal_weight / n);
    for (int i = ted4_schedule_network(t, j.range) - 1; i >= 0; i--) {
        j.range[i].rate *= more;
        j.n_pieces += pieces_of(&j.range[i]);
    }
    ted4_parallel_for(t->parallel, j.n_pieces + t->visible_blocks.n, update_item, &j);
}

/* Weight of squared second differences between knots of gains, as a multiple of that of squares. */
#define SMOOTHNESS 10.0

static void update_exposure(ted4_exposure *e, uint32_t camera, uint32_t frame, const float *d_gain,
                            double rate, double penalty)
{
    const size_t n = 3 * e->n_knots, at = camera * n;

    ted4_exposure_backward(e, camera, frame, d_gain, SMOOTHNESS * penalty, penalty);
    ted4_adam(e->value + at, e->m + at, e->v + at, e->gradient, n, (float)rate,
              ted4_adam_bias_make(++e->steps[camera]));
    ted4_exposure_centre(e);
}

void ted4_colour_update(ted4_colour *c, uint32_t camera, uint32_t frame,
                        const ted4_colour_map gradient, double rate, double penalty)
{
    float *x = c->value[camera], d_gain[3];
    ted4_colour_map g;

    memcpy(g, gradient, sizeof g);
    ted4_colour_split(c, camera, frame, g, d_gain);
    for (int k = 0; k < TED4_COLOUR_VALUES; k++)
        g[k] += (float)(2.0 * penalty) * x[k];
    ted4_adam(x, c->m[camera], c->v[camera], g, TED4_COLOUR_VALUES, (float)rate,
              ted4_adam_bias_make(++c->steps[camera]));
    ted4_colour_centre(c);
    if (c->exposure.n_knots > 0)
        update_exposure(&c->exposure, camera, frame, d_gain, rate, penalty);
}
