/* schedule.c - computes learning rates: see schedule.h. Source: paper, "Progressive 3D-to-4D Anchor
 * Transformation"; annex D.1.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "schedule.h"

#include <math.h>

#include "train/math/adam.h"

/* Ratios of the learning rates at the last and the first step of a stage. */
#define LAST_OFFSET    0.01
#define LAST_MASK      0.01
#define LAST_TAU       0.1
#define LAST_HEADS     0.02
#define LAST_MOTION    0.1
#define LAST_PRIOR     0.02
#define LAST_VALUES    0.1 /* stage 2: features, scalings, phi */
/* In stage 2, attributes start again at this share of their initial rate. */
#define RESTART        (1.0 / 3.0)
/* The logit of a mask that no gradient keeps open has to move from 1 to -4.6, where the mask
 * closes, while its anchor is seen and the rate is still high. So in stages shorter than the
 * published 60,000 and 30,000 steps, logits move faster in proportion, but at most MASK_FASTEST
 * times as fast, as otherwise single pictures would decide. The rate of the temporal mask is
 * MASK_CAUTION times that, because everything that F_deform adds to position and feature is lost at
 * once when it closes. */
#define MASK_STEPS1    60000.0
#define MASK_STEPS2    30000.0
#define MASK_FASTEST   10.0
#define MASK_CAUTION   (1.0 / 3.0)
/* The learning rate of linear scalings, as a share of their quantisation step. */
#define LINEAR_SCALING 0.2
/* The learning rate of log2 b, relative to that of the times a. */
#define TAU_WIDTH      5.0

static double stage_progress(const ted4_trainer *t)
{
    return (double)ted4_stage_position(t) /
           fmax(1.0, t->phase.stage2 ? t->opt.stage2 : t->opt.stage1);
}

uint64_t ted4_activation_step(const ted4_train_options *o)
{
    return o->progressive ? (uint64_t)ceil(o->activation_start * (double)o->stage1) : 0;
}

/* Returns whether activation spans are learnt yet. Before that, they keep their initial values. */
static int activation_learnt(const ted4_trainer *t)
{
    return t->layout.first[TED4_TAU] >= 0 &&
           (t->phase.stage2 || ted4_stage_position(t) >= ted4_activation_step(&t->opt));
}

static void fill(float *rate, int first, int n, double value)
{
    for (int c = 0; first >= 0 && c < n; c++)
        rate[first + c] = (float)value;
}

static double mask_rate(const ted4_trainer *t)
{
    const double pace = t->phase.stage2 ? MASK_STEPS2 / fmax(1.0, t->opt.stage2)
                                        : MASK_STEPS1 / fmax(1.0, t->opt.stage1);

    return ted4_decay(t->opt.lr_mask * fmin(pace, MASK_FASTEST), LAST_MASK, stage_progress(t));
}

void ted4_schedule_rates(const ted4_trainer *t, float *rate)
{
    const ted4_train_options *o = &t->opt;
    const ted4_layout *l = &t->layout;
    const double p = stage_progress(t);
    const double restart = t->phase.stage2 ? RESTART : 1.0;
    const double values = t->phase.stage2 ? ted4_decay(restart, LAST_VALUES, p) : 1.0;
    const double tau = ted4_decay(o->lr_tau * restart, LAST_TAU, p);
    const double scale_step =
        o->linear_scale ? o->step_scaling
                        : (double)l->head.step[TED4_SCALING]; /* linear because a trial chose it */

    fill(rate, l->first[TED4_FEATURE], l->head.feature_dim, o->lr_feature * values);
    fill(rate, l->first[TED4_SCALING], 6,
         (l->head.scale_domain == TED4_SCALE_LOG2 ? o->lr_scaling : LINEAR_SCALING * scale_step) *
             values);
    fill(rate, l->first[TED4_OFFSET], 3 * l->head.n_offsets,
         t->phase.stage2 ? ted4_decay(o->lr_offset * 0.1, 0.1, p)
                         : ted4_decay(o->lr_offset, LAST_OFFSET, p));
    fill(rate, l->first[TED4_PHI], l->head.phi_dim, o->lr_phi * values);
    if (l->first[TED4_TAU] >= 0) {
        const int on = activation_learnt(t);

        for (int c = 0; c < 4; c++)
            rate[l->first[TED4_TAU] + c] = (float)(on ? tau * (c % 2 == 1 ? TAU_WIDTH : 1.0) : 0.0);
    }
    fill(rate, l->offset_logit, l->head.n_offsets, t->phase.stage2 ? mask_rate(t) : 0.0);
    fill(rate, l->temporal_logit, 1, MASK_CAUTION * mask_rate(t));
    for (int c = 0; c < l->n_channels; c++)
        rate[c] *= (float)t->monitor.state.factor;
}

/* Returns rate, or 0 in the integer stage for weights on a coarse grid, as they would jump between
 * points of the grid until the end. */
static double rate_on_weight_grid(const ted4_trainer *t, ted4_weight_grid grid, double rate)
{
    return t->phase.integer && t->net.bits[grid] < TED4_WEIGHT_GRID_FULL(grid) ? 0 : rate;
}

static ted4_net_range make_range(const ted4_trainer *t, size_t first, size_t n, double rate)
{
    return (ted4_net_range) { first, n, (float)(rate * t->monitor.state.factor) };
}

int ted4_schedule_network(const ted4_trainer *t, ted4_net_range *range)
{
    const ted4_train_options *o = &t->opt;
    const ted4_layout *l = &t->layout;
    const double p = stage_progress(t);
    const double restart = t->phase.stage2 ? RESTART : 1.0;
    const double heads = rate_on_weight_grid(t, TED4_WEIGHT_GRID_HEADS,
                                             ted4_decay(o->lr_heads * restart, LAST_HEADS, p));
    const double motion = ted4_decay(o->lr_motion * restart, LAST_MOTION, p);

    int n = 0;

    for (int i = 0; i < TED4_NETS_R; i++) {
        const int is_motion = i == TED4_NET_PROJECT || i == TED4_NET_DEFORM;
        const ted4_net_shape *s = &l->shape.netr[i];

        range[n++] =
            make_range(t, l->netr + s->first, ted4_network_size(s),
                       is_motion ? rate_on_weight_grid(t, TED4_WEIGHT_GRID_MOTION, motion) : heads);
    }
    range[n++] = make_range(t, l->bank, (size_t)l->shape.n_bank,
                            rate_on_weight_grid(t, TED4_WEIGHT_GRID_BANK, motion));
    if (t->phase.stage2 && !t->phase.integer)
        range[n++] =
            make_range(t, l->nete, l->shape.n_nete, ted4_decay(o->lr_prior, LAST_PRIOR, p));
    return n;
}
