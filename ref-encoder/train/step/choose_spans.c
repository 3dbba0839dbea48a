/* choose_spans.c - chooses the symbols of life spans by rate and distortion: see choose_spans.h.
 * Many spans begin before the first frame or end after the last one. There, and wherever an edge
 * lies between two frames, much of a symbol has no effect on any picture, so that training does not
 * change it, but the file pays for it.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "choose_spans.h"

#include <math.h>
#include <stdlib.h>

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

static double part_bits(const ted4_coded_span *s, int part)
{
    double bits = 0;

    (void)ted4_gauss_put(s->mu[part], s->sigma[part], s->k[part], add_slots, &bits);
    return bits;
}

double ted4_span_bits(const ted4_coded_span *s)
{
    double bits = 0;

    for (int i = 0; i < TED4_SPAN_PARTS; i++)
        bits += part_bits(s, i);
    return bits;
}

static float part_value(const ted4_coded_span *s, int part)
{
    return (float)s->k[part] * s->step;
}

/* The activation beyond an edge, at the times from first to last - 1 (spec 11.4). */
static void beyond_edge(const float *time, const float *tau, float at, size_t first, size_t last,
                        float *activation)
{
    if (first == last)
        return;

    const float width = ted4_find_edge(time[first], tau, ted4_pow2).width;

    for (size_t i = first; i < last; i++)
        activation[i] = ted4_activation((time[i] - at) / width, ted4_pow2);
}

void ted4_span_activation(const ted4_coded_span *s, const float *time, size_t n, float *activation)
{
    float tau[TED4_SPAN_PARTS * TED4_LANES];
    size_t first = 0, last = n; /* times within the span */

    for (int i = 0; i < TED4_SPAN_PARTS; i++)
        tau[i * TED4_LANES] = part_value(s, i);

    const float start = tau[START * TED4_LANES], end = tau[END * TED4_LANES];

    while (first < n && time[first] < start)
        first++;
    while (last > first && time[last - 1] > end)
        last--;
    beyond_edge(time, tau, start, 0, first, activation);
    for (size_t i = first; i < last; i++)
        activation[i] = 1;
    beyond_edge(time, tau, end, last, n, activation);
}

/* Times at which activations by two spans may differ, as indices from first to last - 1. Of so many
 * that follow each other, one is looked at. */
typedef struct {
    size_t first, last, each;
} time_range;

/* FAR: in widths; so far beyond an edge, activation is e^-16, and its square a billionth of what a
 * bit is worth. FINE: at least so many times are looked at in one width, if there are more than
 * ENOUGH in all; from one to the next, activation changes by a twentieth at most. */
#define FAR 4.0
enum { FINE = 16, ENOUGH = 512 };

static double width_of(const ted4_coded_span *s, int edge)
{
    return (double)fmaxf(ted4_pow2(part_value(s, edge + 1)), TED4_EDGE_MIN);
}

/* Returns how many of n times from 0 to 1 are before t. */
static size_t count_before(double t, size_t n)
{
    return (size_t)fmin(fmax(ceil(t * (double)(n - 1)), t > 0), (double)n);
}

/* The times beyond an edge of either span; no further ones, where both activations are nearly 0.
 * inner, outer: distances in the direction of the edge, which is backwards for the start. */
static time_range find_range(const ted4_coded_span *a, const ted4_coded_span *b, int edge, size_t n)
{
    const double side = edge == START ? -1 : 1;
    const double at[2] = { (double)part_value(a, edge), (double)part_value(b, edge) };
    const double width[2] = { width_of(a, edge), width_of(b, edge) };
    const double inner = fmin(side * at[0], side * at[1]);
    const double outer = fmax(side * at[0] + FAR * width[0], side * at[1] + FAR * width[1]);
    const double apart = fmin(fmin(width[0], width[1]) / FINE, 1.0 / ENOUGH);
    const size_t each = (size_t)fmax(apart * (double)(n - 1), 1);

    if (edge == START)
        return (time_range) { count_before(-outer, n), count_before(-inner, n), each };
    return (time_range) { count_before(inner, n), count_before(outer, n), each };
}

/* The search for one symbol. */
typedef struct {
    ted4_coded_span *s;
    ted4_coded_span given;
    int part;
    size_t n; /* number of times */
    int best;
    double least; /* cost of the best symbol so far */
} search;

/* Adds the squared differences between activations by the present and the given span to sum, until
 * that is most or more. */
static double add_changes(const search *f, time_range r, double sum, double most)
{
    enum { RUN = 64 };
    float time[RUN], now[RUN], given[RUN];

    while (r.first < r.last && sum < most) {
        size_t n = 0, weight[RUN];

        for (; n < RUN && r.first < r.last; n++, r.first += r.each) {
            weight[n] = r.last - r.first < r.each ? r.last - r.first : r.each;
            time[n] = ted4_span_time(r.first + weight[n] / 2, f->n);
        }
        ted4_span_activation(f->s, time, n, now);
        ted4_span_activation(&f->given, time, n, given);
        for (size_t i = 0; i < n; i++)
            sum += (double)weight[i] * (double)((now[i] - given[i]) * (now[i] - given[i]));
    }
    return sum;
}

/* Returns the mean squared difference between activations by the present and the given span, or,
 * once it is at least f->least, some number that is. */
static double change(const search *f)
{
    const double most = f->least * (double)f->n;
    const time_range start = find_range(f->s, &f->given, START, f->n);
    time_range end = find_range(f->s, &f->given, END, f->n);

    if (end.first < start.last) /* one span is before the other */
        end.first = start.last;
    return add_changes(f, end, add_changes(f, start, 0, most), most) / (double)f->n;
}

/* A symbol, the change of activation and the bits that it means. */
typedef struct {
    int k;
    double change, bits;
} candidate;

static candidate try_symbol(search *f, int k)
{
    candidate c = { .k = k };

    f->s->k[f->part] = k;
    c.change = change(f);
    c.bits = part_bits(f->s, f->part);
    if (c.change + WORTH * c.bits < f->least) {
        f->least = c.change + WORTH * c.bits;
        f->best = k;
    }
    return c;
}

/* Searches between two symbols, of which far is nearer to the mean. On the way there, bits become
 * fewer and the change becomes larger, at every time, as long as the other symbols are as given.
 * What lies between costs at least the change of the one and the bits of the other. */
static void search_between(search *f, candidate near, candidate far)
{
    if (abs(far.k - near.k) <= 1 || near.change + WORTH * far.bits >= f->least)
        return;

    const candidate middle = try_symbol(f, near.k + (far.k - near.k) / 2);

    search_between(f, near, middle);
    search_between(f, middle, far);
}

/* Moves one symbol towards its mean; true if it has changed. */
static int choose_part(search *f, int part)
{
    ted4_coded_span *s = f->s;
    const int given = s->k[part];
    int mean = ted4_clamp(ted4_round_shift(s->mu[part], TED4_MU_BITS), -MOST, MOST);

    if (part == START) /* R-ATT-001: a_s is at most a_f */
        mean = mean < s->k[END] ? mean : s->k[END];
    else if (part == END)
        mean = mean > s->k[START] ? mean : s->k[START];
    if (mean == given)
        return 0;
    f->part = part;
    f->least = INFINITY;
    f->best = given;

    const candidate near = try_symbol(f, given), far = try_symbol(f, mean);

    search_between(f, near, far);
    s->k[part] = f->best;
    return f->best != given;
}

void ted4_span_choose(ted4_coded_span *s, size_t n)
{
    search f = { .s = s, .given = *s, .n = n };
    int changed = 1;

    for (int pass = 0; changed && pass < PASSES; pass++) {
        changed = 0;
        for (int i = 0; i < TED4_SPAN_PARTS; i++)
            changed |= choose_part(&f, part_order[i]);
    }
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

static int nearest_symbol(float value, float step)
{
    return (int)fmaxf(-MOST, fminf(MOST, rintf(value / step)));
}

/* Returns the span of an anchor as it would be rounded. out: the outputs of the hyperprior for it,
 * TED4_PRIOR_BLOCK apart. */
static ted4_coded_span rounded_span(ted4_trainer *t, size_t anchor, const int32_t *out)
{
    const ted4_shape *shape = &t->layout.shape;
    const int32_t *model = out + (size_t)shape->first_output[TED4_TAU] * TED4_PRIOR_BLOCK;
    const uint8_t index = ted4_step_index(out[step_row(shape) * TED4_PRIOR_BLOCK]);
    ted4_coded_span s = { .step = t->layout.head.step[TED4_TAU] *
                                  ted4_bits_float(ted4_step[index]) };

    for (int i = 0; i < TED4_SPAN_PARTS; i++) {
        s.k[i] = nearest_symbol(*tau_value(t, anchor, i), s.step);
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
        ted4_coded_span chosen = rounded_span(t, first + j, out + j);

        ted4_span_choose(&chosen, ted4_span_n_times(t->data->n_frames));
        for (int part = 0; part < TED4_SPAN_PARTS; part++) {
            float *value = tau_value(t, first + j, part);

            if (nearest_symbol(*value, chosen.step) != chosen.k[part])
                *value = part_value(&chosen, part);
        }
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
