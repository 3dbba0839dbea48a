/* schedule.c - learning rates over time, and what happens at which step. Source: paper,
 * "Progressive 3D-to-4D Anchor Transformation"; annex D.1.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <math.h>

#include "train/math/adam.h"
#include "train/densify/mv_seed.h"
#include "train/state/trainer.h"

/* Factors between the first and the last step of a stage. */
#define LAST_OFFSET    0.01
#define LAST_MASK      0.01
#define LAST_TAU       0.1
#define LAST_HEADS     0.02
#define LAST_MOTION    0.1
#define LAST_PRIOR     0.02
#define LAST_VALUES    0.1 /* stage 2: features, scalings, phi */
/* Stage 2 restarts attributes at a third of their first rate. */
#define RESTART        (1.0 / 3.0)
/* A mask that nothing defends has to come from 1 to where it closes, -4.6, while its anchor is seen
 * and the rate still high: stages shorter than the published 60,000 and 30,000 steps let logits
 * move faster in proportion, but never so fast that single pictures decide. The temporal mask goes
 * at a third of that: when it closes, all that F_deform had added to place and feature is gone at
 * once. */
#define MASK_STEPS1    60000.0
#define MASK_STEPS2    30000.0
#define MASK_FASTEST   10.0
#define MASK_CAUTION   (1.0 / 3.0)
/* Linear scalings move by this share of their quantisation step. */
#define LINEAR_SCALING 0.2
/* log2 b moves five times as fast as the times a. */
#define TAU_WIDTH      5.0

static double stage_progress(const ted4_trainer *t)
{
    const double done = (double)(t->iteration - (t->stage2 ? t->stage2_start : 0));

    return done / fmax(1.0, t->stage2 ? t->opt.stage2 : t->opt.stage1);
}

/* The step from which activation is learnt: the end of the static phase, if there is one. */
static uint64_t activation_start(const ted4_train_options *o)
{
    return o->progressive ? (uint64_t)ceil(o->activation_start * (double)o->stage1) : 0;
}

/* Are activation spans learnt yet? Before, they stay as they were seeded. */
static int activation_learnt(const ted4_trainer *t)
{
    return t->layout.first[TED4_TAU] >= 0 &&
           (t->stage2 || t->iteration >= activation_start(&t->opt));
}

static void fill(float *rate, int first, int n, double value)
{
    for (int c = 0; first >= 0 && c < n; c++)
        rate[first + c] = (float)value;
}

static double mask_rate(const ted4_trainer *t)
{
    const double pace = t->stage2 ? MASK_STEPS2 / fmax(1.0, t->opt.stage2)
                                  : MASK_STEPS1 / fmax(1.0, t->opt.stage1);

    return ted4_decay(t->opt.lr_mask * fmin(pace, MASK_FASTEST), LAST_MASK, stage_progress(t));
}

void ted4_schedule_rates(const ted4_trainer *t, float *rate)
{
    const ted4_train_options *o = &t->opt;
    const ted4_layout *l = &t->layout;
    const double p = stage_progress(t);
    const double restart = t->stage2 ? RESTART : 1.0;
    const double values = t->stage2 ? ted4_decay(restart, LAST_VALUES, p) : 1.0;
    const double tau = ted4_decay(o->lr_tau * restart, LAST_TAU, p);
    const double scale_step =
        o->linear_scale ? o->step_scaling
                        : (double)l->head.step[TED4_SCALING]; /* linear by choice of a trial */

    fill(rate, l->first[TED4_FEATURE], l->head.feature_dim, o->lr_feature * values);
    fill(rate, l->first[TED4_SCALING], 6,
         (l->head.scale_domain == TED4_SCALE_LOG2 ? o->lr_scaling : LINEAR_SCALING * scale_step) *
             values);
    fill(rate, l->first[TED4_OFFSET], 3 * l->head.n_offsets,
         t->stage2 ? ted4_decay(o->lr_offset * 0.1, 0.1, p)
                   : ted4_decay(o->lr_offset, LAST_OFFSET, p));
    fill(rate, l->first[TED4_PHI], l->head.phi_dim, o->lr_phi * values);
    if (l->first[TED4_TAU] >= 0) {
        const int on = activation_learnt(t);

        for (int c = 0; c < 4; c++)
            rate[l->first[TED4_TAU] + c] = (float)(on ? tau * (c % 2 == 1 ? TAU_WIDTH : 1.0) : 0.0);
    }
    fill(rate, l->offset_logit, l->head.n_offsets, t->stage2 ? mask_rate(t) : 0.0);
    fill(rate, l->temporal_logit, 1, MASK_CAUTION * mask_rate(t));
    for (int c = 0; c < l->n_channels; c++)
        rate[c] *= (float)t->watch.state.factor;
}

/* In the integer stage no weight leaves a coarse grid: it would jump from point to point until the
 * end. */
static double rate_on_grid(const ted4_trainer *t, ted4_grid grid, double rate)
{
    return t->integer && t->bits[grid] < TED4_GRID_FULL(grid) ? 0 : rate;
}

static size_t network_size(const ted4_net_shape *s)
{
    size_t n = 0;

    for (int i = 0; i < s->n_layers; i++)
        n += ((size_t)s->dim[i] + 1) * s->dim[i + 1];
    return n;
}

static ted4_net_range make_range(const ted4_trainer *t, size_t first, size_t n, double rate)
{
    return (ted4_net_range) { first, n, (float)(rate * t->watch.state.factor) };
}

int ted4_schedule_network(const ted4_trainer *t, ted4_net_range *range)
{
    const ted4_train_options *o = &t->opt;
    const ted4_layout *l = &t->layout;
    const double p = stage_progress(t);
    const double restart = t->stage2 ? RESTART : 1.0;
    const double heads =
        rate_on_grid(t, TED4_GRID_HEADS, ted4_decay(o->lr_heads * restart, LAST_HEADS, p));
    const double motion = ted4_decay(o->lr_motion * restart, LAST_MOTION, p);

    int n = 0;

    for (int i = 0; i < TED4_NETS_R; i++) {
        const int is_motion = i == TED4_NET_PROJECT || i == TED4_NET_DEFORM;
        const ted4_net_shape *s = &l->shape.netr[i];

        range[n++] = make_range(t, l->netr + s->first, network_size(s),
                                is_motion ? rate_on_grid(t, TED4_GRID_MOTION, motion) : heads);
    }
    range[n++] = make_range(t, l->bank, l->shape.n_bank, rate_on_grid(t, TED4_GRID_BANK, motion));
    if (t->stage2 && !t->integer)
        range[n++] =
            make_range(t, l->nete, l->shape.n_nete, ted4_decay(o->lr_prior, LAST_PRIOR, p));
    return n;
}

/* Growth begins after a twentieth of stage 1; statistics as soon as the last adjustment is done. */
#define GROW_FROM 0.05

/* Sprouts come when what stays is drawn well enough for what does not to stand out, and before
 * activation is learnt. Where cameras take turns nothing else finds what moves, so they come before
 * the probe asks whether time is needed. */
#define SPROUT_AT       0.3
#define SPROUT_AT_TURNS 0.2

static uint64_t sprout_step(const ted4_trainer *t, int reach)
{
    return (uint64_t)((reach > 0 ? SPROUT_AT_TURNS : SPROUT_AT) * (double)t->opt.stage1);
}

/* Are anchors kept for sprouts that are still to come? */
static int sprouts_ahead(const ted4_trainer *t)
{
    if (t->stage2 || t->opt.sprouts <= 0 || t->iteration >= sprout_step(t, 0))
        return 0;

    const int reach = ted4_sprout_reach(t);

    return reach >= 0 && t->iteration < sprout_step(t, reach);
}

static int sprouts_due(const ted4_trainer *t)
{
    if (t->stage2 || t->opt.sprouts <= 0 ||
        (t->iteration != sprout_step(t, 0) && t->iteration != sprout_step(t, 1)))
        return 0;

    const int reach = ted4_sprout_reach(t);

    return reach >= 0 && t->iteration == sprout_step(t, reach);
}

void ted4_schedule_growth(const ted4_trainer *t, double *from, double *sprout_at, double *sprouts)
{
    const int reach = ted4_sprout_reach(t);

    *from = GROW_FROM;
    *sprout_at = reach > 0 ? SPROUT_AT_TURNS : SPROUT_AT;
    *sprouts = reach >= 0 ? t->opt.sprouts : 0.0;
}

size_t ted4_schedule_room(const ted4_trainer *t)
{
    const size_t most =
        (size_t)((sprouts_ahead(t) ? 1.0 - t->opt.sprouts : 1.0) * (double)t->opt.max_anchors);

    return t->anchors.n < most ? most - t->anchors.n : 0;
}

int ted4_integer_due(const ted4_trainer *t)
{
    const double first = (1.0 - t->opt.integer_share) * (double)t->opt.stage2;

    return t->stage2 && !t->integer && t->iteration >= (uint64_t)t->opt.stage1 + (uint64_t)first;
}

int ted4_schedule_event(ted4_trainer *t)
{
    const ted4_train_options *o = &t->opt;
    const uint64_t i = t->iteration, stage1 = (uint64_t)o->stage1;

    if (t->layout.first[TED4_TAU] >= 0 && !t->stage2 && i == activation_start(o) &&
        ted4_activation_begin(t) != 0)
        return -1;
    if (sprouts_due(t) && ted4_sprout(t) != 0)
        return -1;
    if (!t->stage2 && i > (uint64_t)(GROW_FROM * (double)stage1) &&
        i <= (uint64_t)(o->grow_until * (double)stage1) && i % (uint64_t)o->grow_every == 0 &&
        ted4_densify_adjust(t) != 0)
        return -1;
    if (i == stage1 && !t->stage2 && o->stage2 > 0 && ted4_stage2_begin(t) != 0)
        return -1;
    if (ted4_integer_due(t) && ted4_integer_begin(t) != 0)
        return -1;
    return 0;
}
