/* choose_spans.c - chooses the symbols of life spans by rate and distortion: see choose_spans.h.
 * Many spans begin before the first frame or end after the last one. There, and wherever an edge
 * lies between two frames, much of a symbol has no effect on any picture, so that training does not
 * change it, but the file pays for it.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "choose_spans.h"

#include <math.h>

#include "base/bytes.h"
#include "kernel/int_kernel.h"
#include "math/elementary.h"
#include "norm/half.h"
#include "norm/prior.h"
#include "train/model/formulas.h"
#include "write/gauss_put.h"

/* Distortion that a bit is worth, as a mean squared change of activation. A typical anchor covers a
 * thousandth of a picture and differs by a fifth of the range from what is behind it, so that a
 * mean squared change of 1 changes the mean squared error by 5e-5. In bench/bd_rate.csv, a bit of
 * kitchen is worth 1e-9 at lambda 0.002, which would be 2e-5 here; half of that leaves more of the
 * activation. A tenth of it saves only a little less, and ten times as much a little more
 * (bench/compact.md). */
#define WORTH 1e-5

enum { START = 0, END = 2, PASSES = 2, MOST = 32767 /* R-ENT-007 */ };

/* a_s and a_f first: widths matter less once an edge is out of sight. */
static const int part_order[TED4_SPAN_PARTS] = { START, END, START + 1, END + 1 };

static void add_slots(void *bits, ted4_slots s)
{
    *(double *)bits += TED4_SLOT_BITS - ted4_math_log2(s.freq);
}

static double part_bits(const ted4_span *s, int part)
{
    double bits = 0;

    (void)ted4_gauss_put(s->mu[part], s->sigma[part], s->k[part], add_slots, &bits);
    return bits;
}

double ted4_span_bits(const ted4_span *s)
{
    double bits = 0;

    for (int i = 0; i < TED4_SPAN_PARTS; i++)
        bits += part_bits(s, i);
    return bits;
}

/* tau: the values, TED4_LANES floats apart, as ted4_find_edge takes them. */
static void span_values(const ted4_span *s, float *tau)
{
    for (int i = 0; i < TED4_SPAN_PARTS; i++)
        tau[i * TED4_LANES] = (float)s->k[i] * s->step;
}

static double activation_at(float time, const float *tau)
{
    return (double)ted4_activation(ted4_find_edge(time, tau, ted4_pow2).u, ted4_pow2);
}

double ted4_span_change(const ted4_span *a, const ted4_span *b, uint32_t n_frames, double most)
{
    const uint32_t n = 2 * n_frames - 1;
    const double enough = most * n;
    float tau_a[TED4_SPAN_PARTS * TED4_LANES], tau_b[TED4_SPAN_PARTS * TED4_LANES];
    double sum = 0;

    span_values(a, tau_a);
    span_values(b, tau_b);
    for (uint32_t i = 0; i < n && sum <= enough; i++) {
        const float time = n > 1 ? (float)i / (float)(n - 1) : 0.0f;
        const double d = activation_at(time, tau_a) - activation_at(time, tau_b);

        sum += d * d;
    }
    return sum / n;
}

/* Moves one symbol towards its mean, step by step. The further it goes, the fewer bits it takes,
 * and the more the activation differs, at every time; so the search ends when that difference alone
 * costs more than the best symbol so far. */
static void choose_part(ted4_span *s, const ted4_span *given, uint32_t n_frames, int part)
{
    const int mean = ted4_clamp(ted4_round_shift(s->mu[part], TED4_MU_BITS), -MOST, MOST);
    const int toward = mean > s->k[part] ? 1 : -1;
    int best = s->k[part];
    double least = ted4_span_change(s, given, n_frames, INFINITY) + WORTH * part_bits(s, part);

    for (int k = best; k != mean;) {
        k += toward;
        s->k[part] = k;
        if (s->k[START] > s->k[END])
            break; /* R-ATT-001 */
        const double change = ted4_span_change(s, given, n_frames, least);
        const double cost = change + WORTH * part_bits(s, part);

        if (change > least)
            break;
        if (cost < least) {
            least = cost;
            best = k;
        }
    }
    s->k[part] = best;
}

void ted4_span_choose(ted4_span *s, uint32_t n_frames)
{
    const ted4_span given = *s;

    for (int pass = 0; pass < PASSES; pass++)
        for (int i = 0; i < TED4_SPAN_PARTS; i++)
            choose_part(s, &given, n_frames, part_order[i]);
}

/* What choosing needs of all blocks. */
typedef struct {
    ted4_trainer *t;
    ted4_prior prior;
    int32_t *out; /* [BATCH][P][64], owned by the arena: outputs of the hyperprior */
    size_t first; /* the first block of the batch */
} chooser;

enum { BATCH = 64 };

static float *tau_value(ted4_trainer *t, size_t anchor, int part)
{
    return ted4_anchor_value(&t->anchors, TED4_ROW_VALUE, anchor, t->layout.first[TED4_TAU] + part);
}

/* The row of the hyperprior's outputs from which the step of tau follows. */
static size_t step_row(const ted4_shape *s)
{
    size_t row = s->first_step_output;

    for (int type = 0; type < TED4_TAU; type++)
        row += s->dim[type] > 0;
    return row;
}

/* Returns the span of an anchor as it would be rounded. out: the outputs of the hyperprior for it,
 * TED4_PRIOR_BLOCK apart. */
static ted4_span rounded_span(ted4_trainer *t, size_t anchor, const int32_t *out)
{
    const ted4_shape *shape = &t->layout.shape;
    const int32_t *model = out + (size_t)shape->first_output[TED4_TAU] * TED4_PRIOR_BLOCK;
    const uint8_t index = ted4_step_index(out[step_row(shape) * TED4_PRIOR_BLOCK]);
    ted4_span s = { .step = t->layout.head.step[TED4_TAU] * ted4_bits_float(ted4_step[index]) };

    for (int i = 0; i < TED4_SPAN_PARTS; i++) {
        const float k = rintf(*tau_value(t, anchor, i) / s.step);

        s.k[i] = (int)fmaxf(-MOST, fminf(MOST, k));
        s.mu[i] = model[i * TED4_PRIOR_BLOCK];
        s.sigma[i] = ted4_sigma_index(model[(TED4_SPAN_PARTS + i) * TED4_PRIOR_BLOCK]);
    }
    if (s.k[END] < s.k[START])
        s.k[END] = s.k[START]; /* as export_scene.c rounds it */
    return s;
}

static void choose_block(void *arg, size_t i)
{
    const chooser *c = arg;
    ted4_trainer *t = c->t;
    const size_t first = (c->first + i) * TED4_LANES, left = t->anchors.n - first;
    const size_t n = left < TED4_LANES ? left : TED4_LANES;
    int32_t *out = c->out + i * t->layout.shape.n_outputs * TED4_PRIOR_BLOCK;
    uint16_t position[TED4_LANES][3] = { { 0 } };

    for (size_t j = 0; j < n; j++)
        for (int axis = 0; axis < 3; axis++)
            position[j][axis] = ted4_float_to_half(
                *ted4_anchor_value(&t->anchors, TED4_ROW_POSITION, first + j, axis));
    ted4_prior_hyper(&c->prior, position[0], n, out);
    for (size_t j = 0; j < n; j++) {
        const ted4_span given = rounded_span(t, first + j, out + j);
        ted4_span chosen = given;

        ted4_span_choose(&chosen, t->data->n_frames);
        for (int part = 0; part < TED4_SPAN_PARTS; part++)
            if (chosen.k[part] != given.k[part])
                *tau_value(t, first + j, part) = (float)chosen.k[part] * chosen.step;
    }
}

int ted4_choose_spans(ted4_trainer *t)
{
    const size_t n_blocks = t->anchors.n_blocks;
    chooser c = { .t = t };
    ted4_arena arena;
    int bad;

    if (t->layout.first[TED4_TAU] < 0)
        return 0;
    ted4_arena_init(&arena, NULL);
    bad = ted4_prior_init(&c.prior, &t->layout.head, &t->layout.shape, &arena) != TED4_OK ||
          ted4_prior_load(&c.prior, t->net.value + t->layout.nete, t->net.shift, NULL) != TED4_OK;
    c.prior.dense = ted4_select_int_dense();
    c.out = ted4_arena_alloc(&arena, BATCH * (size_t)t->layout.shape.n_outputs,
                             TED4_PRIOR_BLOCK * sizeof *c.out);
    bad = bad || c.out == NULL;
    for (c.first = 0; !bad && c.first < n_blocks; c.first += BATCH)
        ted4_parallel_for(t->parallel, n_blocks - c.first < BATCH ? n_blocks - c.first : BATCH,
                          choose_block, &c);
    ted4_arena_finish(&arena);
    return bad ? ted4_trainer_fail(t, "no memory to choose spans, or weights beyond the prior") : 0;
}
