/* resize.c - resizes a trainer's model: layout, anchors, then networks. See resize.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "resize_nets.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "math/elementary.h"
#include "train/model/init.h"

void ted4_resize_begin(ted4_resize *s, const ted4_trainer *t)
{
    memset(s, 0, sizeof *s);
    s->head = t->layout.head;
    for (int k = 0; k < TED4_MAX_OFFSETS; k++)
        s->offset[k] = k;
}

/* Finds the old channel of each new channel: [n_channels of to]. */
static void match_channels(const ted4_resize *s, const ted4_layout *from, const ted4_layout *to,
                           int *channel)
{
    for (int y = 0; y < TED4_TYPES; y++)
        for (int c = 0; c < (int)to->shape.dim[y]; c++) {
            const ted4_pruned_units *w = y == TED4_FEATURE ? s->feature
                                         : y == TED4_PHI   ? s->phi
                                                           : NULL;
            const int old = y == TED4_OFFSET ? 3 * s->offset[c / 3] + c % 3
                            : w != NULL      ? w->keep[c]
                                             : c;

            channel[to->first[y] + c] = from->first[y] + old;
        }
    for (int k = 0; k < to->head.n_offsets; k++)
        channel[to->offset_logit + k] = from->offset_logit + s->offset[k];
    channel[to->temporal_logit] = from->temporal_logit;
}

/* Copies the anchors to the new layout, except the statistics of densification, which is over. */
static int map_anchors(const ted4_trainer *t, const ted4_resize *s, const ted4_layout *from,
                       const ted4_anchors *old)
{
    const ted4_anchors *new = &t->anchors;
    int *channel = malloc((size_t)t->layout.n_channels * sizeof *channel);

    if (channel == NULL)
        return -1;
    match_channels(s, from, &t->layout, channel);
    for (ted4_row r = TED4_ROW_VALUE; r <= TED4_ROW_V; r++)
        for (size_t b = 0; b < old->n_blocks; b++)
            for (int c = 0; c < t->layout.n_channels; c++)
                memcpy(ted4_block(new, r, b) + c * TED4_LANES,
                       ted4_block(old, r, b) + channel[c] * TED4_LANES, TED4_LANES * sizeof(float));
    for (ted4_row r = TED4_ROW_POSITION; r <= TED4_ROW_OPACITY; r++)
        memcpy(new->data[r], old->data[r],
               old->n_blocks * (size_t)old->rows[r] * TED4_LANES * sizeof(float));
    free(channel);
    return 0;
}

/* Computes the mean context of each feature, the input of the slice networks, in units of Q0. */
static void mean_contexts(const ted4_layout *l, const ted4_anchors *a, float *context)
{
    for (int c = 0; c < l->head.feature_dim; c++) {
        double sum = 0;

        for (size_t i = 0; i < a->n; i++)
            sum += (double)*ted4_anchor_value(a, TED4_ROW_VALUE, i, l->first[TED4_FEATURE] + c);
        context[c] =
            (float)(sum / ((double)(a->n > 0 ? a->n : 1) * (double)l->head.step[TED4_FEATURE]));
    }
}

/* Converts scalings to the other domain. The prior that was learnt for them no longer applies, and
 * is reset to their mean and spread. */
static void change_domain(ted4_trainer *t)
{
    ted4_layout *l = &t->layout;
    const int first = l->first[TED4_SCALING], linear = l->head.scale_domain == TED4_SCALE_LINEAR;
    ted4_anchors *a = &t->anchors;

    for (size_t i = 0; i < a->n; i++) {
        for (int c = 0; c < 6; c++) {
            float *x = ted4_anchor_value(a, TED4_ROW_VALUE, i, first + c);

            *x = linear ? ted4_math_exp2f(*x) : ted4_math_log2f(fmaxf(*x, 1e-6f));
            *ted4_anchor_value(a, TED4_ROW_M, i, first + c) =
                *ted4_anchor_value(a, TED4_ROW_V, i, first + c) = 0;
        }
        *ted4_anchor_value(a, TED4_ROW_STEP, i, TED4_SCALING) = l->head.step[TED4_SCALING];
    }
    ted4_init_prior_type(t->net.value, l, a, TED4_SCALING);
}

int ted4_resize_apply(ted4_trainer *t, const ted4_resize *s)
{
    const ted4_layout from = t->layout;
    ted4_anchors old = t->anchors;
    float *net[TED4_RESIZE_ARRAYS] = { t->net.value, t->net.m, t->net.v },
          context[TED4_MAX_FEATURE];
    int bad;

    mean_contexts(&from, &old, context);
    ted4_layout_make(&t->layout, &s->head);
    t->net.value = t->net.m = t->net.v = NULL;
    bad = ted4_anchors_init(&t->anchors, &t->layout) != 0 ||
          ted4_anchors_resize(&t->anchors, old.n) != 0 || ted4_trainer_rebuild(t) != 0;
    if (!bad) {
        const ted4_resize_nets n = { s,
                                     &from,
                                     &t->layout,
                                     context,
                                     { net[0], net[1], net[2] },
                                     { t->net.value, t->net.m, t->net.v } };

        bad = map_anchors(t, s, &from, &old) != 0 || ted4_resize_networks(&n) != 0;
    }
    if (!bad && s->head.scale_domain != from.head.scale_domain)
        change_domain(t);
    ted4_anchors_finish(&old);
    for (int i = 0; i < TED4_RESIZE_ARRAYS; i++)
        free(net[i]);
    return bad ? ted4_trainer_fail(t, "no memory to change the model") : 0;
}
