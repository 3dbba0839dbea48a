/* update.c - what is added to the gradients of a picture (volume, bank, masks, rate), and the optimiser's step. See trainer.h.
 * Source: paper, "Training Objectives"; annex D.1.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <math.h>

#include "adam.h"
#include "gradients.h"
#include "math/quick.h"
#include "random.h"
#include "trainer.h"

size_t ted4_update_volume(ted4_trainer *t, const ted4_splats *s)
{
    ted4_splat_grads *g = &t->splat_gradient;
    size_t            n = 0;

    for (size_t i = 0; i < s->n; i++)
        n += g->visible[i];

    const float w = n > 0 ? (float)(t->opt.volume_weight / (double)n) : 0.0f;
    uint32_t    drawn = 0;

#pragma omp simd reduction(+ : drawn)
    for (size_t i = 0; i < s->n; i++) {
        const float on = w * (float)g->visible[i];
        const float a = s->scale[0][i], b = s->scale[1][i], c = s->scale[2][i];

        g->scale[0][i] += on * b * c;
        g->scale[1][i] += on * a * c;
        g->scale[2][i] += on * a * b;
        drawn += a >= TED4_NO_EXTENT || b >= TED4_NO_EXTENT || c >= TED4_NO_EXTENT ? g->visible[i] : 0u;
    }
    t->watch.drawn = (double)drawn;
    return n;
}

void ted4_update_bank(ted4_trainer *t)
{
    const ted4_header *h = &t->layout.head;
    const size_t       D = h->bank_dim, M = h->bank_rows;
    const float       *z = t->net + t->layout.bank;
    float             *d = t->net_gradient + t->layout.bank;

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

/* Largest number of channels that header ranges allow (model.h). */
enum { MAX_CHANNELS = TED4_MAX_FEATURE + 6 + 4 * TED4_MAX_OFFSETS + TED4_MAX_PHI + 4 + 1 };

typedef struct {
    ted4_trainer *t;
    float         rate[MAX_CHANNELS];
    ted4_adam_bias bias;
    float         mask_weight, temporal_weight;
} slot_job;

/* d sigmoid(logit) times weight, for the anchors of the slot. */
static void add_mask_loss(const slot_job *j, size_t i, int channel, int n, float weight)
{
    const ted4_slots *s = &j->t->slots;

    for (int c = channel; c < channel + n; c++) {
        const float   *x = s->raw[i] + c * TED4_LANES;
        float         *d = s->gradient[i] + c * TED4_LANES;
        const uint32_t lanes = s->lanes[i];

#pragma omp simd
        for (int k = 0; k < TED4_LANES; k++) {
            const float m = ted4_quick_logistic(x[k]);
            const float on = (float)(int32_t)(lanes >> k & 1);

            d[k] += on * weight * m * (1.0f - m);
        }
    }
}

static void update_slot(void *arg, size_t i)
{
    const slot_job    *j = arg;
    ted4_trainer      *t = j->t;
    const ted4_slots  *s = &t->slots;
    const ted4_layout *l = &t->layout;
    float *x = ted4_block(&t->anchors, TED4_ROW_VALUE, s->block[i]);
    float *m = ted4_block(&t->anchors, TED4_ROW_M, s->block[i]);
    float *v = ted4_block(&t->anchors, TED4_ROW_V, s->block[i]);

    if (j->mask_weight > 0)
        add_mask_loss(j, i, l->offset_logit, l->head.n_offsets, j->mask_weight);
    if (j->temporal_weight > 0)
        add_mask_loss(j, i, l->temporal_logit, 1, j->temporal_weight);
    ted4_gradients_slot(l, j->rate, x, s->gradient[i], s->squares + i * (TED4_SLOT_TERMS + 1));
    for (int c = 0; c < l->n_channels; c++) {
        const size_t at = (size_t)c * TED4_LANES;

        if (j->rate[c] > 0)
            ted4_adam(x + at, m + at, v + at, s->gradient[i] + at, TED4_LANES, j->rate[c],
                      j->bias);
    }
}

void ted4_update_parameters(ted4_trainer *t)
{
    const ted4_header *h = &t->layout.head;
    const uint64_t     count = t->iteration - (t->stage2 ? t->stage2_start : 0) + 1;
    const double       n = (double)t->anchors.n;
    slot_job           j = { .t = t, .bias = ted4_adam_bias_make(count) };

    ted4_schedule_rates(t, j.rate);
    if (t->stage2 && h->offset_mask)
        j.mask_weight = (float)(t->opt.lambda * t->opt.mask_weight / (n * t->charged.n_offsets));
    if (h->motion != TED4_MOTION_NONE && h->temporal_mask)
        j.temporal_weight = (float)(t->opt.temporal_weight / n);
    ted4_parallel_for(t->parallel, t->slots.n, update_slot, &j);
    ted4_schedule_network_step(t);
}

/* A partial shuffle: after m swaps the first m slots are a uniform choice; the order of the others does not matter. */
static void swap_slots(ted4_slots *s, size_t i, size_t k)
{
    const uint32_t block = s->block[i], lanes = s->lanes[i], drawn = s->drawn[i];
    const float   *position = s->position[i], *raw = s->raw[i], *used = s->used[i];
    float         *gradient = s->gradient[i], *steps = s->steps[i];

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
    ted4_slots  *s = &t->slots;
    const size_t want = (size_t)ceil(t->opt.rate_share * (double)s->n);
    const size_t m = want < s->n ? want : s->n;
    const double params = ted4_trainer_charged(t);
    double       bits[TED4_TYPES], chosen = 0;

    for (size_t i = 0; i < m; i++)
        swap_slots(s, i, i + ted4_below(key, i, (uint32_t)(s->n - i)));
    for (size_t i = 0; i < m; i++)
        for (uint32_t x = s->lanes[i]; x != 0; x &= x - 1)
            chosen += 1;

    ted4_rate_input in = {
        &t->layout, t->net, t->shift, m, s->raw, s->position, s->lanes, s->block, key,
        t->integer ? TED4_QUANT_INTEGER : TED4_QUANT_NOISE,
        (float)(t->opt.lambda / (fmax(chosen, 1) * params)), (float)((double)s->n / (double)m),
        t->layout.head.activation
    };

    if (!t->integer)
        ted4_rate_pack(t->rate, t->net);
    if (m > 0 && ted4_rate_evaluate(t->rate, &in, t->parallel, (const float *const *)s->gradient,
                                    s->gradient, t->net_gradient, s->steps, bits) != 0)
        return ted4_trainer_fail(t, "no memory for the rate model");
    for (int y = 0; y < TED4_TYPES && chosen > 0; y++)
        t->progress.bits[y] += 0.02 * (bits[y] / chosen - t->progress.bits[y]);
    return 0;
}
