/* stages.c - the changes between phases of training: see stages.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "stages.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "train/model/formulas.h"
#include "math/elementary.h"
#include "train/model/header_from_options.h"
#include "settle_positions.h"
#include "train/resize/feature_pca.h"
#include "train/model/init.h"
#include "train/densify/short_lived.h"
#include "train/state/anchor_appearance.h"
#include "train/state/arrangement.h"
#include "train/state/visible_blocks.h"
#include "write/snap.h"

/* spec 11: returns the time of frame j. */
static float frame_time(const ted4_trainer *t, uint32_t j)
{
    return t->data->n_frames > 1 ? (float)j / (float)(t->data->n_frames - 1) : 0.0f;
}

/* By how much the initial span is shorter, at each end, than the times at which the anchor is seen;
 * half a frame if that is less. This is a tenth of b, so the anchor fades by at most 1 %. */
#define SPAN_INSIDE 0.01f

/* Widens span[2 i], span[2 i + 1] to the first and the last time at which a training view sees
 * anchor i; they do not change if none does. */
static void widen_spans(const ted4_trainer *t, float *span)
{
    const ted4_anchors *a = &t->anchors;

    for (size_t i = 0; i < t->data->n_pictures; i++) {
        const ted4_picture *pic = &t->data->pictures[i];
        const float now = frame_time(t, pic->frame);
        ted4_view v;
        float centre[3];

        if (pic->is_test)
            continue;
        ted4_trainer_view(t, pic, &v, centre);
        for (size_t b = 0; b < a->n_blocks; b++) {
            const uint32_t seen = ted4_block_visible(t, b, &v);

            for (size_t j = 0; j < TED4_LANES; j++) {
                float *s = span + 2 * (b * TED4_LANES + j);

                if (seen >> j & 1) {
                    s[0] = fminf(s[0], now);
                    s[1] = fmaxf(s[1], now);
                }
            }
        }
    }
}

/* Initialises each anchor's activation, except those of short-lived anchors, with the span between
 * the first and the last time at which a training view sees it (without the static phase: all
 * times). The span is a little shorter at both ends: if the first frame of the sequence were
 * exactly at a_s, no time would ever be before it, and its gradient would always be zero (annex
 * D.1, traps). */
int ted4_activation_begin(ted4_trainer *t)
{
    ted4_anchors *a = &t->anchors;
    const int first = t->layout.first[TED4_TAU];
    const float inside = fminf(SPAN_INSIDE, 0.5f / fmaxf((float)t->data->n_frames - 1.0f, 1.0f));
    float *span = malloc((a->n_blocks + 1) * 2 * TED4_LANES * sizeof *span);

    if (span == NULL)
        return ted4_trainer_fail(t, "no memory to start activation");
    for (size_t i = 0; i < a->n_blocks * TED4_LANES; i++) {
        span[2 * i] = 2.0f;
        span[2 * i + 1] = -1.0f;
    }
    if (t->opt.progressive)
        widen_spans(t, span);
    for (size_t i = 0; i < a->n; i++) {
        const int never = span[2 * i] > span[2 * i + 1];
        float from = (never ? 0.0f : span[2 * i]) + inside;
        float to = (never ? 1.0f : span[2 * i + 1]) - inside;

        if (from > to)
            from = to = 0.5f * (from + to);
        if (ted4_is_short_lived(t, i))
            continue;
        *ted4_anchor_value(a, TED4_ROW_VALUE, i, first) = from;
        *ted4_anchor_value(a, TED4_ROW_VALUE, i, first + 2) = to;
    }
    free(span);
    return ted4_arrange_anchors(t);
}

/* Returns the highest activation of anchor i over the frames of the sequence, in stage 2 with the
 * values that the file will contain. All blocks must be in t->visible_blocks, as
 * ted4_anchor_appearance leaves them. */
static float peak_activation(const ted4_trainer *t, size_t i)
{
    const int first = t->layout.first[TED4_TAU];
    float least = INFINITY;

    if (first < 0)
        return 1.0f;
    const float *tau = t->visible_blocks.used[i / TED4_LANES] + (size_t)first * TED4_LANES +
                       i % TED4_LANES;

    for (uint32_t j = 0; j < t->data->n_frames; j++)
        least = fminf(least, fabsf(ted4_find_edge(frame_time(t, j), tau, ted4_pow2).u));
    return ted4_activation(least, ted4_pow2);
}

int ted4_stage_live(ted4_trainer *t, uint32_t *live, size_t *n)
{
    float *sum = malloc((t->anchors.n + 1) * sizeof *sum);
    int bad = sum == NULL ? ted4_trainer_fail(t, "no memory to look for idle anchors")
                          : ted4_anchor_appearance(t, sum, NULL);

    *n = 0;
    for (size_t i = 0; !bad && i < t->anchors.n; i++)
        if ((double)(sum[i] * peak_activation(t, i)) >= t->opt.prune_opacity)
            live[(*n)++] = (uint32_t)i;
    free(sum);
    return bad;
}

int ted4_stage_drop_dead(ted4_trainer *t)
{
    uint32_t *order = malloc((t->anchors.n + 1) * sizeof *order);
    size_t n = 0;
    int bad = order == NULL ? ted4_trainer_fail(t, "no memory to drop idle anchors")
                            : ted4_stage_live(t, order, &n);

    if (!bad && n == 0)
        bad = ted4_trainer_fail(t, "nothing is left to encode");
    if (!bad && n < t->anchors.n && ted4_anchors_select(&t->anchors, order, n) != 0)
        bad = ted4_trainer_fail(t, "no memory to drop idle anchors");
    free(order);
    return bad;
}

/* Copies the channels of one kind of row from the old layout to the new one. */
static void remap_row(const ted4_layout *from, const ted4_layout *to, const ted4_anchors *old,
                      ted4_anchors *new, ted4_row row)
{
    for (size_t i = 0; i < old->n; i++) {
        for (int y = 0; y < TED4_TYPES; y++)
            for (unsigned c = 0; c < to->shape.dim[y]; c++)
                *ted4_anchor_value(new, row, i, to->first[y] + (int)c) =
                    *ted4_anchor_value(old, row, i, from->first[y] + (int)c);
        for (int k = 0; k < to->head.n_offsets; k++)
            *ted4_anchor_value(new, row, i, to->offset_logit + k) =
                *ted4_anchor_value(old, row, i, from->offset_logit + k);
        *ted4_anchor_value(new, row, i, to->temporal_logit) =
            *ted4_anchor_value(old, row, i, from->temporal_logit);
    }
}

/* Copies a kind of row that does not depend on the layout. */
static void copy_row(const ted4_anchors *old, ted4_anchors *new, ted4_row row)
{
    memcpy(new->data[row], old->data[row],
           old->n_blocks * (size_t)old->rows[row] * TED4_LANES * sizeof(float));
}

/* Copies one of the arrays of network parameters, except NETE, which stays zero. */
static void remap_networks(const ted4_layout *from, const ted4_layout *to, const float *old,
                           float *new)
{
    for (int i = 0; i < TED4_NETS_R; i++) {
        const ted4_net_shape *s = &to->shape.netr[i];

        memcpy(new + to->netr + s->first, old + from->netr + from->shape.netr[i].first,
               ted4_network_size(s) * sizeof *new);
    }
    memcpy(new + to->bank, old + from->bank, (size_t)to->shape.n_bank * sizeof *new);
}

int ted4_stage_relayout(ted4_trainer *t, const ted4_header *h)
{
    const ted4_layout from = t->layout;
    ted4_anchors old = t->anchors;
    float *net[3] = { t->net.value, t->net.m, t->net.v };
    int bad;

    ted4_layout_make(&t->layout, h);
    t->net.value = t->net.m = t->net.v = NULL;
    bad = ted4_anchors_init(&t->anchors, &t->layout) != 0 ||
          ted4_anchors_resize(&t->anchors, old.n) != 0 || ted4_trainer_rebuild(t) != 0;
    if (!bad) {
        for (ted4_row r = TED4_ROW_VALUE; r <= TED4_ROW_V; r++)
            remap_row(&from, &t->layout, &old, &t->anchors, r);
        for (ted4_row r = TED4_ROW_POSITION; r <= TED4_ROW_GRADIENT; r++)
            copy_row(&old, &t->anchors, r);
        remap_networks(&from, &t->layout, net[0], t->net.value);
        remap_networks(&from, &t->layout, net[1], t->net.m);
        remap_networks(&from, &t->layout, net[2], t->net.v);
    }
    ted4_anchors_finish(&old);
    for (int i = 0; i < 3; i++)
        free(net[i]);
    return bad ? ted4_trainer_fail(t, "no memory to change the model") : 0;
}

/* Motion is dropped if at most the share MOVING_SHARE of anchors moves, and activation if at most
 * that share has an activation below ALWAYS_THERE at any time. */
#define MOVING_SHARE 0.002
#define ALWAYS_THERE 0.98f

static float least_activation(const ted4_trainer *t, size_t i)
{
    const float *tau = ted4_anchor_value(&t->anchors, TED4_ROW_VALUE, i, t->layout.first[TED4_TAU]);

    const float first = ted4_find_edge(0, tau, ted4_pow2).u,
                last = ted4_find_edge(1, tau, ted4_pow2).u;

    return ted4_activation(fmaxf(fabsf(first), fabsf(last)), ted4_pow2);
}

/* Removes the parts of the model that have no effect from the header. */
static void simplify(const ted4_trainer *t, ted4_header *h)
{
    const double few = MOVING_SHARE * (double)t->anchors.n;
    size_t moving = 0, absent = 0;

    for (size_t i = 0; i < t->anchors.n; i++) {
        const float logit =
            *ted4_anchor_value(&t->anchors, TED4_ROW_VALUE, i, t->layout.temporal_logit);

        moving += ted4_mask_on(logit);
        absent += h->activation && least_activation(t, i) < ALWAYS_THERE;
    }
    if (h->motion != TED4_MOTION_NONE && h->temporal_mask && (double)moving <= few)
        ted4_header_without_motion(h);
    if (h->activation && (double)absent <= few)
        h->activation = 0;
}

/* Converts the model to the one that stage 2 trains. */
static int reshape(ted4_trainer *t)
{
    ted4_header h = t->layout.head;
    const int linear = t->opt.linear_scale;

    simplify(t, &h);
    h.scale_domain = linear ? TED4_SCALE_LINEAR : TED4_SCALE_LOG2;
    if (ted4_stage_relayout(t, &h) != 0)
        return -1;
    for (size_t i = 0; linear && i < t->anchors.n; i++)
        for (int c = 0; c < 6; c++) {
            float *x = ted4_anchor_value(&t->anchors, TED4_ROW_VALUE, i,
                                         t->layout.first[TED4_SCALING] + c);

            *x = ted4_math_exp2f(*x);
        }
    return 0;
}

static void clear_moments(ted4_trainer *t)
{
    for (int r = TED4_ROW_M; r <= TED4_ROW_V; r++)
        memset(t->anchors.data[r], 0,
               t->anchors.n_blocks * (size_t)t->layout.n_channels * TED4_LANES * sizeof(float));
    memset(t->net.m, 0, t->layout.n_net * sizeof *t->net.m);
    memset(t->net.v, 0, t->layout.n_net * sizeof *t->net.v);
}

int ted4_stage2_begin(ted4_trainer *t)
{
    if (ted4_settle_positions(t) != 0 || ted4_stage_drop_dead(t) != 0 || reshape(t) != 0)
        return -1;
    if (t->opt.capacity && ted4_feature_pca(t) != 0)
        return -1;
    ted4_init_prior(t->net.value, &t->layout, &t->anchors, t->opt.seed);
    clear_moments(t);
    if (ted4_arrange_anchors(t) != 0)
        return -1;
    for (size_t i = 0; i < t->anchors.n; i++)
        for (int y = 0; y < TED4_TYPES; y++)
            *ted4_anchor_value(&t->anchors, TED4_ROW_STEP, i, y) = t->layout.head.step[y];
    t->phase.stage2 = 1;
    t->phase.rate_norm_header = t->layout.head;
    t->phase.stage2_start = t->iteration;
    return 0;
}

/* Returns the number of fraction bits of the contexts, the largest, up to 10, that leaves a factor
 * of two before 16 bits saturate. */
static uint8_t context_bits(const ted4_trainer *t)
{
    const int first = t->layout.first[TED4_FEATURE];
    float largest = 1.0f;
    int bits = 10;

    for (size_t i = 0; i < t->anchors.n; i++)
        for (int c = 0; c < t->layout.head.feature_dim; c++)
            largest = fmaxf(largest,
                            fabsf(*ted4_anchor_value(&t->anchors, TED4_ROW_VALUE, i, first + c)) /
                                t->layout.head.step[TED4_FEATURE]);
    while (bits > 0 && ldexpf(largest, bits) > 16383.0f)
        bits--;
    return (uint8_t)bits;
}

/* From here on, the prior is that of the file: its weights are snapped to the integer grid and
 * fixed, and so are the step sizes. Other weights on a coarse grid are fixed, too. */
int ted4_integer_begin(ted4_trainer *t)
{
    t->layout.head.context_bits = context_bits(t);
    ted4_rate_free(t->work.rate);
    t->work.rate = ted4_rate_new(&t->layout);
    t->net.shift = malloc(t->layout.shape.n_units + 1);
    if (t->net.shift == NULL || t->work.rate == NULL || ted4_visible_blocks_fill(t, NULL) != 0)
        return ted4_trainer_fail(t, "no memory for the integer model");
    ted4_snap_coarse(&t->layout.head, &t->layout.shape, t->net.bits[TED4_WEIGHT_GRID_PRIOR],
                     t->net.value + t->layout.nete, t->net.shift);
    ted4_weight_grid_scene(&t->layout.shape, t->net.bits, t->net.value + t->layout.netr,
                           t->net.value + t->layout.bank);
    t->phase.integer = 1;
    ted4_rate_pack(t->work.rate, t->net.value);
    return ted4_integer_rate(t, NULL);
}

int ted4_integer_rate(ted4_trainer *t, double *bits)
{
    if (ted4_visible_blocks_fill(t, NULL) != 0)
        return -1;

    const ted4_rate_input in = ted4_visible_blocks_rate(t);

    return ted4_rate_evaluate(t->work.rate, &in, t->parallel, NULL, NULL, NULL,
                              t->visible_blocks.steps, bits) != 0
               ? ted4_trainer_fail(t, "no memory for the integer model, or weights beyond it")
               : 0;
}
