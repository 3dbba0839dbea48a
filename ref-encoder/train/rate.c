/* rate.c - the trainer's float model of Tier E (spec 7.3, 9.4, 10): bits of chosen anchors, and their gradients through rate_bwd.c.
 * Inputs, units and sums are the decoder's: positions in Q12 as spec 10.1 rounds them, mu in steps, s = log2(sigma / step), q = Q0 2^v,
 * contexts k q / Q0. Only roundings inside the networks are missing, and with TED4_QUANT_INTEGER (rate_integer.c) not even those.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "rate_parts.h"

#include <stdlib.h>
#include <string.h>

#include "norm/sine.h"
#include "rate_math.h"

enum { ALIGN = 16, REDUCE_PIECE = 4096 };       /* floats */

static int net_init(ted4_rate_net *n, const ted4_net_shape *shape, int n_steps)
{
    size_t at = shape->first;

    n->n = shape->n_layers;
    for (int i = 0; i <= n->n; i++)
        n->dim[i] = shape->dim[i];
    for (int i = 0; i < n->n; i++) {
        const int out = n->dim[i + 1] - (i == n->n - 1 ? n_steps : 0);

        n->w[i] = at;
        n->b[i] = at + (size_t)n->dim[i] * (size_t)n->dim[i + 1];
        at = n->b[i] + (size_t)n->dim[i + 1];
        if (ted4_dense_init(&n->layer[i], n->dim[i], out) != 0)
            return -1;
    }
    return 0;
}

static void net_finish(ted4_rate_net *n)
{
    for (int i = 0; i < n->n; i++)
        ted4_dense_finish(&n->layer[i]);
}

ted4_rate *ted4_rate_new(const ted4_layout *l)
{
    ted4_rate *r = calloc(1, sizeof *r);
    const ted4_shape *shape = &l->shape;
    const int n_steps = (int)shape->n_types;

    if (r == NULL)
        return NULL;
    r->layout = *l;
    for (int i = 0; i < TED4_RATE_WAVE; i++)
        atomic_flag_clear(&r->busy[i]);
    int failed = net_init(&r->hyper, &shape->hyper, n_steps);

    if (!failed)
        failed = ted4_dense_init(&r->step, r->hyper.dim[r->hyper.n - 1],
                                 n_steps);
    for (int m = 1; m < l->head.n_slices && !failed; m++)
        failed = net_init(&r->slice[m], &shape->slice[m], 0);
    if (failed) {
        ted4_rate_free(r);
        return NULL;
    }
    return r;
}

void ted4_rate_free(ted4_rate *r)
{
    if (r == NULL)
        return;
    for (size_t i = 0; i < TED4_RATE_WAVE; i++) {
        free(r->room[i].storage);
        free(r->sums[i].d_net);
    }
    ted4_rate_integer_end(&r->integer);
    net_finish(&r->hyper);
    ted4_dense_finish(&r->step);
    for (int m = 0; m < TED4_MAX_SLICES; m++)
        net_finish(&r->slice[m]);
    free(r);
}

void ted4_rate_pack(ted4_rate *r, const float *net)
{
    const float *nete = net + r->layout.nete;
    const ted4_rate_net *h = &r->hyper;
    const size_t last = (size_t)h->n - 1, rows = (size_t)h->layer[last].out;

    for (int i = 0; i < h->n; i++)
        ted4_dense_pack(&r->hyper.layer[i], nete + h->w[i], nete + h->b[i]);
    ted4_dense_pack(&r->step, nete + h->w[last] + rows * (size_t)h->dim[last],
                    nete + h->b[last] + rows);
    for (int m = 1; m < r->layout.head.n_slices; m++)
        for (int i = 0; i < r->slice[m].n; i++)
            ted4_dense_pack(&r->slice[m].layer[i], nete + r->slice[m].w[i],
                            nete + r->slice[m].b[i]);
}

/* ---- workspaces ---- */

/* Hands out pieces of storage; with base NULL it only counts. */
typedef struct {
    float *base;
    size_t n;
} arena;

static float *take(arena *a, size_t n)
{
    float *p = a->base != NULL ? a->base + a->n : NULL;

    a->n += (n + ALIGN - 1) / ALIGN * ALIGN;
    return p;
}

static void take_acts(arena *a, const ted4_rate_net *n, int with_input,
                      ted4_rate_acts *acts)
{
    for (int i = 0; i <= n->n; i++) {
        const size_t size = ted4_row((size_t)n->dim[i] * TED4_RATE_CHUNK);

        if (i > 0 || with_input)
            acts->x[i] = take(a, size);
        if (i > 0)
            acts->d[i] = take(a, size);
    }
}

static void take_room(arena *a, const ted4_rate *r, ted4_rate_room *room)
{
    const ted4_layout *l = &r->layout;
    const size_t channels = ted4_row((size_t)l->offset_logit);
    const size_t offsets = ted4_row(l->head.n_offsets);
    const size_t context = ted4_row(l->shape.dim[TED4_FEATURE]);
    ted4_rate_slot *s = &room->slot;

    take_acts(a, &r->hyper, 1, &room->hyper);
    room->context = take(a, context * TED4_RATE_CHUNK);
    room->integer = (int32_t *)take(a, l->shape.n_outputs * TED4_PRIOR_BLOCK);
    for (int m = 1; m < l->head.n_slices; m++)
        take_acts(a, &r->slice[m], 0, &room->slice[m]);
    s->value = take(a, channels);
    s->residual = take(a, channels);
    s->d_symbol = take(a, channels);
    s->used = take(a, TED4_LANES);
    s->dynamic = take(a, TED4_LANES);
    s->phi_bits = take(a, TED4_LANES);
    s->kept = take(a, offsets);
    s->kept_bits = take(a, offsets);
    s->d_context = take(a, context);
}

static int rooms(ted4_rate *r, size_t n)
{
    for (; r->n_rooms < n; r->n_rooms++) {
        ted4_rate_room *room = &r->room[r->n_rooms];
        ted4_rate_sums *sums = &r->sums[r->n_rooms];
        arena a = { NULL, 0 };

        take_room(&a, r, room);
        if (room->storage == NULL)
            room->storage = aligned_alloc(64, a.n * sizeof(float));
        if (sums->d_net == NULL)
            sums->d_net = malloc(r->layout.shape.n_nete * sizeof(float));
        if (room->storage == NULL || sums->d_net == NULL)
            return -1;
        a = (arena){ room->storage, 0 };
        take_room(&a, r, room);
    }
    return 0;
}

/* The first free room: few are ever touched, so they stay in the caches. */
static size_t room_enter(ted4_rate *r)
{
    for (size_t i = 0;; i = (i + 1) % r->n_rooms)
        if (!atomic_flag_test_and_set_explicit(&r->busy[i],
                                               memory_order_acquire))
            return i;
}

static void room_leave(ted4_rate *r, size_t i)
{
    atomic_flag_clear_explicit(&r->busy[i], memory_order_release);
}

/* ---- forward ---- */

static void sine_row(const uint32_t *phase, uint32_t turn, int shift, float *row)
{
#pragma omp simd
    for (int j = 0; j < TED4_LANES; j++)
        row[j] = (float)ted4_sine((phase[j] << shift) + turn) * 0x1p-12f;
}

/* spec 10.1: inputs of the hyperprior, the integers of the text divided by 4096. */
static void encode_positions(const ted4_header *h, const float *position,
                             uint32_t lanes, float *x)
{
    uint32_t phase[3][TED4_LANES];

    if (h->prior == TED4_PRIOR_FACTORISED)
        return;
    for (int a = 0; a < 3; a++) {
        const float *p = position + ted4_row((size_t)a);

        for (int j = 0; j < TED4_LANES; j++) {
            const float known = lanes >> j & 1 ? p[j] : 0.0f;

            phase[a][j] = (uint32_t)(int32_t)(known * 0x1p24f) << 7;
            *x++ = __builtin_floorf(known * 0x1p12f) * 0x1p-12f;
        }
    }
    for (int l = 0; l < h->pe_octaves; l++)
        for (int a = 0; a < 3; a++, x += 2 * TED4_LANES) {
            sine_row(phase[a], 0, l, x);
            sine_row(phase[a], 0x40000000u, l, x + TED4_LANES);
        }
}

/* q = Q0 2^v, and 1 for absent types. v: rows of the present types. */
static void step_sizes(const ted4_layout *l, const float *v, float *q)
{
    for (int t = 0; t < TED4_TYPES; t++, q += TED4_LANES) {
        const int present = l->shape.dim[t] > 0;

        for (int j = 0; j < TED4_LANES; j++)
            q[j] = !present ? 1.0f : l->head.step[t]
                 * ted4_lane_pow2(ted4_lane_limit(v[j], TED4_V_MIN,
                                                  TED4_V_MAX));
        v += present ? TED4_LANES : 0;
    }
}

/* The hyperprior up to its rows v, and the steps q. The other outputs come in slot_forward. */
static void steps_forward(const ted4_rate_job *job, ted4_rate_room *room,
                          size_t i, size_t slot)
{
    const ted4_rate *r = job->rate;
    const ted4_rate_net *h = &r->hyper;
    const ted4_layout *l = job->in->layout;
    float *x = room->hyper.x[0] + i * ted4_row((size_t)h->dim[0]);

    encode_positions(&l->head, job->in->position[slot], job->in->lanes[slot],
                     x);
    for (int k = 0; k < h->n - 1; k++) {
        float *y = room->hyper.x[k + 1] + i * ted4_row((size_t)h->dim[k + 1]);

        ted4_dense_forward(&h->layer[k], x, y, 1);
        x = y;
    }
    float *v = room->hyper.x[h->n] + i * ted4_row(l->shape.n_outputs)
             + ted4_row(l->shape.first_step_output);

    ted4_dense_forward(&r->step, x, v, 0);
    step_sizes(l, v, job->steps[slot]);
    if (job->integer != NULL)
        ted4_rate_integer_steps(job, room, slot, v, job->steps[slot]);
}

/* Values and masks of the lanes in use. */
static void load_slot(const ted4_rate_job *job, ted4_rate_slot *s, size_t slot)
{
    const ted4_layout *l = job->in->layout;
    const float *attr = job->in->attr[slot];
    const float *logit = attr + ted4_row((size_t)l->offset_logit);
    const float *moves = attr + ted4_row((size_t)l->temporal_logit);
    const uint32_t lanes = job->in->lanes[slot];

    for (size_t c = 0; c < (size_t)l->offset_logit; c++)
        for (size_t j = 0; j < TED4_LANES; j++)
            s->value[ted4_row(c) + j] = lanes >> j & 1 ? attr[ted4_row(c) + j]
                                                       : 0.0f;
    for (size_t j = 0; j < TED4_LANES; j++) {
        const int in_use = lanes >> j & 1;
        int any = 0;

        for (size_t k = 0; k < l->head.n_offsets; k++) {
            const int on = in_use && (!l->head.offset_mask
                                 || ted4_mask_on(logit[ted4_row(k) + j]));

            s->kept[ted4_row(k) + j] = on ? 1.0f : 0.0f;
            any |= on;
        }
        s->used[j] = any ? 1.0f : 0.0f;
        s->dynamic[j] = any && (!l->head.temporal_mask
                                || ted4_mask_on(moves[j])) ? 1.0f : 0.0f;
    }
}

/* spec 10.3: contexts, and what each slice network adds to mu and s of its slice. */
static void slices_forward(const ted4_rate_job *job, ted4_rate_room *room,
                           size_t i, size_t slot)
{
    const ted4_rate *r = job->rate;
    const ted4_layout *l = job->in->layout;
    const size_t f = l->shape.dim[TED4_FEATURE];
    const size_t first = ted4_row((size_t)l->first[TED4_FEATURE]);
    const float *value = room->slot.value + first;
    const float *residual = room->slot.residual + first;
    const float *q = job->steps[slot] + ted4_row(TED4_FEATURE);
    const float unit = 1.0f / l->head.step[TED4_FEATURE];
    float *context = room->context + i * ted4_row(f);
    float *out = room->hyper.x[r->hyper.n] + i * ted4_row(l->shape.n_outputs)
               + ted4_row(l->shape.first_output[TED4_FEATURE]);

    for (size_t c = 0; c < f; c++)
        for (size_t j = 0, at = ted4_row(c); j < TED4_LANES; j++)
            context[at + j] = (value[at + j] + q[j] * residual[at + j]) * unit;
    for (size_t m = 1, known = 0; m < l->head.n_slices; m++) {
        const ted4_rate_net *n = &r->slice[m];
        float *hidden = room->slice[m].x[1] + i * ted4_row((size_t)n->dim[1]);
        float *y = room->slice[m].x[2] + i * ted4_row((size_t)n->dim[2]);
        const size_t half = ted4_row(l->head.slice[m]);

        known += l->head.slice[m - 1];
        ted4_dense_forward(&n->layer[0], context, hidden, 1);
        ted4_dense_forward(&n->layer[1], hidden, y, 0);
        for (size_t j = 0; j < half; j++) {
            out[ted4_row(known) + j] += y[j];
            out[ted4_row(known + f) + j] += y[half + j];
        }
    }
}

/* ---- bits ---- */

/* The lanes that count component c of type t, and where its bits are gathered. */
static const float *component_mask(ted4_rate_slot *s, int t, size_t c,
                                   float *type_bits, float **gathered)
{
    const size_t k = ted4_row(c / 3);           /* offset 3k + j: spec 10.2 */

    if (t == TED4_OFFSET) {
        *gathered = s->kept_bits + k;
        return s->kept + k;
    }
    *gathered = t == TED4_PHI ? s->phi_bits : type_bits;
    return t == TED4_PHI ? s->dynamic : s->used;
}

/* Bits of one component, and dL/d(k, mu, s). A clamped s has a gradient only where it leads back inside. */
static void component_bits(float weight, const float *mask, const float *k_mu,
                           const float *s, float *d_symbol, float *d_mu,
                           float *d_s, float *gathered)
{
    float bits[TED4_LANES], d_u[TED4_LANES], d_raw[TED4_LANES];

    ted4_rate_row(k_mu, s, bits, d_u, d_raw);
#pragma omp simd
    for (int j = 0; j < TED4_LANES; j++) {
        const float w = weight * mask[j], ds = w * d_raw[j];

        gathered[j] += bits[j];
        d_symbol[j] = w * d_u[j];
        d_mu[j] = -w * d_u[j];
        d_s[j] = ted4_inward(s[j], TED4_S_MIN, TED4_S_MAX, ds);
    }
}

static double masked_sum(const float *bits, const float *mask)
{
    double sum = 0.0;

    for (int j = 0; j < TED4_LANES; j++)
        sum += mask[j] > 0.0f ? (double)bits[j] : 0.0;
    return sum;
}

/* Adds the bits of a type to those of the slot's anchors; offsets are apart. total: of a type that is coded for every anchor in use. */
static void tell_lanes(const ted4_rate_job *job, const ted4_rate_slot *s, size_t slot, int t, const float *total)
{
    const size_t K = job->in->layout->head.n_offsets;
    const float *bits = t == TED4_OFFSET ? s->kept_bits : t == TED4_PHI ? s->phi_bits : total;
    const float *mask = t == TED4_OFFSET ? s->kept : t == TED4_PHI ? s->dynamic : s->used;
    float       *to = job->lane_bits + slot * ted4_row(1 + K) + (t == TED4_OFFSET ? TED4_LANES : 0);

    for (size_t j = 0; j < (t == TED4_OFFSET ? ted4_row(K) : TED4_LANES); j++)
        to[j] += mask[j] > 0.0f ? bits[j] : 0.0f;
}

static void type_bits(const ted4_rate_job *job, ted4_rate_room *room, size_t i,
                      size_t slot, int t)
{
    const ted4_shape *shape = &job->in->layout->shape;
    const size_t out = i * ted4_row(shape->n_outputs)
                     + ted4_row(shape->first_output[t]);
    const size_t dim = shape->dim[t], s_rows = ted4_row(dim);
    const float *mu = room->hyper.x[job->rate->hyper.n] + out;
    float *d_mu = room->hyper.d[job->rate->hyper.n] + out;
    const float *q = job->steps[slot] + ted4_row((size_t)t);
    float total[TED4_LANES] = {0};
    ted4_rate_slot *s = &room->slot;

    for (size_t c = 0; c < dim; c++, mu += TED4_LANES, d_mu += TED4_LANES) {
        const size_t at = ted4_row((size_t)job->in->layout->first[t] + c);
        float k_mu[TED4_LANES], *gathered;
        const float *mask = component_mask(s, t, c, total, &gathered);

#pragma omp simd
        for (int j = 0; j < TED4_LANES; j++)
            k_mu[j] = (s->value[at + (size_t)j] / q[j]
                       + s->residual[at + (size_t)j]) - mu[j];
        component_bits(job->in->bit_weight, mask, k_mu, mu + s_rows,
                       s->d_symbol + at, d_mu, d_mu + s_rows, gathered);
    }
    if (job->lane_bits != NULL)
        tell_lanes(job, s, slot, t, total);
    if (t == TED4_OFFSET)
        for (size_t k = 0; k < dim / 3; k++)
            room->sums->bits[t] += masked_sum(s->kept_bits + ted4_row(k),
                                        s->kept + ted4_row(k));
    else
        room->sums->bits[t] += t == TED4_PHI ? masked_sum(s->phi_bits, s->dynamic)
                                       : masked_sum(total, s->used);
}

static void slot_forward(const ted4_rate_job *job, ted4_rate_room *room,
                         size_t i, size_t slot)
{
    const ted4_rate *r = job->rate;
    const ted4_rate_input *in = job->in;
    const ted4_rate_net *h = &r->hyper;
    const int last = h->n - 1;
    const float *hidden = room->hyper.x[last] + i * ted4_row((size_t)h->dim[last]);
    float *out = room->hyper.x[h->n] + i * ted4_row((size_t)h->dim[h->n]);
    ted4_rate_slot *s = &room->slot;

    load_slot(job, s, slot);
    ted4_dense_forward(&h->layer[last], hidden, out, 0);
    ted4_residuals(in->layout, in->quant, s->value, job->steps[slot],
                   in->block[slot], in->key, s->residual);
    slices_forward(job, room, i, slot);
    if (job->integer != NULL)
        ted4_rate_integer_outputs(job, room, job->steps[slot], out);
    memset(s->kept_bits, 0,
           ted4_row(in->layout->head.n_offsets) * sizeof *s->kept_bits);
    memset(s->phi_bits, 0, TED4_LANES * sizeof *s->phi_bits);
    for (int t = 0; t < TED4_TYPES; t++)
        if (ted4_rate_coded(job, t))
            type_bits(job, room, i, slot, t);
}

/* ---- chunks ---- */

static size_t whole_waves(size_t n_slots)
{
    const size_t wave = (size_t)TED4_RATE_CHUNK * TED4_RATE_WAVE;

    return (n_slots + wave - 1) / wave * TED4_RATE_WAVE;
}

static size_t count_chunks(size_t n_slots)
{
    const size_t most = (n_slots + TED4_RATE_LEAST - 1) / TED4_RATE_LEAST, whole = whole_waves(n_slots);

    return whole < most ? whole : most;
}

static size_t chunk_first(const ted4_rate_job *job, size_t chunk)
{
    return job->in->n_slots * chunk / job->n_chunks;
}

static void run_chunk(void *arg, size_t chunk)
{
    const ted4_rate_job *job = arg;
    const size_t entered = room_enter(job->rate);
    ted4_rate_room *room = &job->rate->room[entered];
    const size_t first = chunk_first(job, job->first + chunk);
    const size_t n = chunk_first(job, job->first + chunk + 1) - first;

    room->sums = &job->rate->sums[chunk];
    memset(room->sums->bits, 0, sizeof room->sums->bits);
    for (size_t i = 0; i < n; i++) {
        steps_forward(job, room, i, first + i);
        if (job->steps_only)
            continue;
        slot_forward(job, room, i, first + i);
        if (job->d_attr != NULL)
            ted4_rate_slot_backward(job, room, i, first + i);
    }
    if (job->d_attr != NULL && !job->steps_only)
        ted4_rate_weights_backward(job->rate, room, n);
    room_leave(job->rate, entered);
}

typedef struct {
    const ted4_rate *rate;
    size_t           n_rooms;
    float           *d_nete;
} reduction;

/* Adds the chunks' weight gradients, chunk by chunk. */
static void reduce_piece(void *arg, size_t piece)
{
    const reduction *r = arg;
    const size_t n = r->rate->layout.shape.n_nete;
    const size_t first = piece * REDUCE_PIECE;
    const size_t end = n - first < REDUCE_PIECE ? n : first + REDUCE_PIECE;

    for (size_t k = 0; k < r->n_rooms; k++) {
        const float *from = r->rate->sums[k].d_net;

        for (size_t i = first; i < end; i++)
            r->d_nete[i] += from[i];
    }
}

/* Chunks from job->first on, and what they add to the sums. */
static void run_wave(ted4_rate_job *job, size_t n, const ted4_parallel *p,
                     float *d_net, double *bits)
{
    const ted4_layout *l = job->in->layout;
    const size_t n_pieces = (l->shape.n_nete + REDUCE_PIECE - 1)
                          / REDUCE_PIECE;

    ted4_parallel_for(p, n, run_chunk, job);
    if (job->steps_only)
        return;
    for (size_t k = 0; k < n; k++)
        for (int t = 0; t < TED4_TYPES; t++)
            bits[t] += job->rate->sums[k].bits[t];
    if (job->d_attr != NULL) {
        reduction sum = { job->rate, n, d_net + l->nete };

        ted4_parallel_for(p, n_pieces, reduce_piece, &sum);
    }
}

/* All but rate, input and where results go is filled in here. */
static int evaluate(ted4_rate_job job, const ted4_parallel *p, float *d_net,
                    double *bits)
{
    ted4_rate *r = job.rate;
    const ted4_rate_input *in = job.in;
    const size_t n_chunks = count_chunks(in->n_slots);

    for (int t = 0; t < TED4_TYPES && bits != NULL; t++)
        bits[t] = 0.0;
    if (rooms(r, n_chunks < TED4_RATE_WAVE ? n_chunks : TED4_RATE_WAVE) != 0)
        return -1;
    if (in->quant == TED4_QUANT_INTEGER) {
        if (ted4_rate_integer_begin(r, in) != 0)
            return -1;
        job.integer = &r->integer;
    }
    for (size_t c = 0; c < n_chunks; c += TED4_RATE_WAVE) {
        const size_t left = n_chunks - c;

        job.first = c;
        job.n_chunks = n_chunks;
        run_wave(&job, left < TED4_RATE_WAVE ? left : TED4_RATE_WAVE, p, d_net,
                 bits);
    }
    return 0;
}

int ted4_rate_evaluate(ted4_rate *r, const ted4_rate_input *in,
                       const ted4_parallel *p, const float *const *d_value,
                       float *const *d_attr, float *d_net, float *const *steps,
                       double *bits)
{
    return evaluate((ted4_rate_job){ .rate = r, .in = in, .d_value = d_value,
                                     .d_attr = d_attr, .steps = steps,
                                     .steps_only = bits == NULL },
                    p, d_net, bits);
}

int ted4_rate_lanes(ted4_rate *r, const ted4_rate_input *in,
                    const ted4_parallel *p, float *const *steps, float *lane_bits)
{
    double bits[TED4_TYPES];

    memset(lane_bits, 0, in->n_slots * ted4_row(1u + in->layout->head.n_offsets)
                             * sizeof *lane_bits);
    return evaluate((ted4_rate_job){ .rate = r, .in = in, .steps = steps,
                                     .lane_bits = lane_bits },
                    p, NULL, bits);
}
