/* rate_fwd.c - forward pass of the rate model for a chunk of visible blocks: hyperprior, steps,
 * contexts and bits; gradients through rate_bwd.c. rate.c describes the model. spec 7.3, 9.4, 10.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "rate_lanes.h"

#include <string.h>

#include "train/model/formulas.h"

/* Computes an octave's row of sines and, behind it, the row of cosines. */
static void sine_rows(const uint32_t *phase, int octave, float *row)
{
#pragma omp simd
    for (int j = 0; j < TED4_LANES; j++)
        row[j] = ted4_encode_sine(phase[j] << octave);
#pragma omp simd
    for (int j = 0; j < TED4_LANES; j++)
        row[TED4_LANES + j] = ted4_encode_cosine(phase[j] << octave);
}

/* spec 10.1: the inputs of the hyperprior are the integers of the specification divided by 4096. */
static void encode_positions(const ted4_header *h, const float *position, uint32_t lanes, float *x)
{
    uint32_t phase[3][TED4_LANES];
    int32_t on[TED4_LANES];

    if (h->prior == TED4_PRIOR_FACTORISED)
        return;
    ted4_lane_set(lanes, on);
    for (int a = 0; a < 3; a++) {
        const float *p = position + ted4_row_floats((size_t)a);

#pragma omp simd
        for (int j = 0; j < TED4_LANES; j++) {
            const float known = ted4_lane_keep(on[j], p[j]);

            phase[a][j] = ted4_encode_phase(known);
            x[j] = ted4_encode_coordinate(known);
        }
        x += TED4_LANES;
    }
    for (int l = 0; l < h->pe_octaves; l++)
        for (int a = 0; a < 3; a++, x += 2 * TED4_LANES)
            sine_rows(phase[a], l, x);
}

/* q = Q0 2^v, and 1 for absent types. v: rows of the present types. */
static void step_sizes(const ted4_layout *l, const float *v, float *q)
{
    for (int t = 0; t < TED4_TYPES; t++, q += TED4_LANES) {
        const float step = l->head.step[t];

        if (l->shape.dim[t] == 0) {
            for (int j = 0; j < TED4_LANES; j++)
                q[j] = 1.0f;
            continue;
        }
#pragma omp simd
        for (int j = 0; j < TED4_LANES; j++)
            q[j] = step * ted4_lane_pow2(ted4_lane_limit(v[j], TED4_V_MIN, TED4_V_MAX));
        v += TED4_LANES;
    }
}

/* Evaluates the hyperprior up to its rows v, and the steps q. block_forward computes the other
 * outputs. */
static void steps_forward(const ted4_rate_job *job, ted4_rate_workspace *workspace, size_t i,
                          size_t visible)
{
    const ted4_rate *r = job->rate;
    const ted4_rate_net *h = &r->hyper;
    const ted4_layout *l = job->in->layout;
    float *x = workspace->hyper.x[0] + i * ted4_row_floats((size_t)h->dim[0]);

    encode_positions(&l->head, job->in->position[visible], job->in->lanes[visible], x);
    for (int k = 0; k < h->n - 1; k++) {
        float *y = workspace->hyper.x[k + 1] + i * ted4_row_floats((size_t)h->dim[k + 1]);

        TED4_LEVELED(ted4_dense_forward)(&h->layer[k], x, y, 1);
        x = y;
    }
    float *v = workspace->hyper.x[h->n] + i * ted4_row_floats(l->shape.n_outputs) +
               ted4_row_floats(l->shape.first_step_output);

    TED4_LEVELED(ted4_dense_forward)(&r->step, x, v, 0);
    step_sizes(l, v, job->steps[visible]);
    if (job->integer != NULL)
        ted4_rate_integer_steps(job, workspace, visible, v, job->steps[visible]);
}

/* Loads values and masks of the lanes in use. */
static void load_block(const ted4_rate_job *job, ted4_rate_block *s, size_t visible)
{
    const ted4_layout *l = job->in->layout;
    const float *attr = job->in->attr[visible];
    const float *logit = attr + ted4_row_floats((size_t)l->offset_logit);
    const float *moves = attr + ted4_row_floats((size_t)l->temporal_logit);
    const int32_t all = l->head.offset_mask ? 0 : -1, all_move = l->head.temporal_mask ? 0 : -1;
    int32_t on[TED4_LANES], any[TED4_LANES] = { 0 };

    ted4_lane_set(job->in->lanes[visible], on);
    for (size_t c = 0; c < (size_t)l->offset_logit; c++) {
        const float *from = attr + ted4_row_floats(c);
        float *to = s->value + ted4_row_floats(c);

#pragma omp simd
        for (size_t j = 0; j < TED4_LANES; j++)
            to[j] = ted4_lane_keep(on[j], from[j]);
    }
    for (size_t k = 0; k < l->head.n_offsets; k++) {
        const float *x = logit + ted4_row_floats(k);
        float *kept = s->kept + ted4_row_floats(k);

#pragma omp simd
        for (size_t j = 0; j < TED4_LANES; j++) {
            const int32_t keep = on[j] & (all | -ted4_mask_on(x[j]));

            kept[j] = ted4_lane_keep(keep, 1.0f);
            any[j] |= keep;
        }
    }
#pragma omp simd
    for (size_t j = 0; j < TED4_LANES; j++) {
        s->used[j] = ted4_lane_keep(any[j], 1.0f);
        s->dynamic[j] = ted4_lane_keep(any[j] & (all_move | -ted4_mask_on(moves[j])), 1.0f);
    }
}

/* spec 10.3: computes the contexts, and adds the output of each slice network to mu and s of its
 * slice. */
static void slices_forward(const ted4_rate_job *job, ted4_rate_workspace *workspace, size_t i,
                           size_t visible)
{
    const ted4_rate *r = job->rate;
    const ted4_layout *l = job->in->layout;
    const size_t f = l->shape.dim[TED4_FEATURE];
    const size_t first = ted4_row_floats((size_t)l->first[TED4_FEATURE]);
    const float *value = workspace->current.value + first;
    const float *residual = workspace->current.residual + first;
    const float *q = job->steps[visible] + ted4_row_floats(TED4_FEATURE);
    const float unit = 1.0f / l->head.step[TED4_FEATURE];
    float *context = workspace->context + i * ted4_row_floats(f);
    float *out = workspace->hyper.x[r->hyper.n] + i * ted4_row_floats(l->shape.n_outputs) +
                 ted4_row_floats(l->shape.first_output[TED4_FEATURE]);

    for (size_t c = 0; c < f; c++) {
        const size_t at = ted4_row_floats(c);

#pragma omp simd
        for (size_t j = 0; j < TED4_LANES; j++)
            context[at + j] = (value[at + j] + q[j] * residual[at + j]) * unit;
    }
    for (size_t m = 1, known = 0; m < l->head.n_slices; m++) {
        const ted4_rate_net *n = &r->slice[m];
        float *hidden = workspace->slice[m].x[1] + i * ted4_row_floats((size_t)n->dim[1]);
        float *y = workspace->slice[m].x[2] + i * ted4_row_floats((size_t)n->dim[2]);
        const size_t half = ted4_row_floats(l->head.slice[m]);

        known += l->head.slice[m - 1];
        TED4_LEVELED(ted4_dense_forward)(&n->layer[0], context, hidden, 1);
        TED4_LEVELED(ted4_dense_forward)(&n->layer[1], hidden, y, 0);
#pragma omp simd
        for (size_t j = 0; j < half; j++) {
            out[ted4_row_floats(known) + j] += y[j];
            out[ted4_row_floats(known + f) + j] += y[half + j];
        }
    }
}

/* ---- bits ---- */

/* Returns the mask of the lanes in which component c of type t is coded, and sets *gathered to the
 * row that its bits are added to. */
static const float *component_mask(ted4_rate_block *s, int t, size_t c, float *type_bits,
                                   float **gathered)
{
    const size_t k = ted4_row_floats(c / 3); /* offset 3k + j: spec 10.2 */

    if (t == TED4_OFFSET) {
        *gathered = s->kept_bits + k;
        return s->kept + k;
    }
    *gathered = t == TED4_PHI ? s->phi_bits : type_bits;
    return t == TED4_PHI ? s->dynamic : s->used;
}

/* Computes the bits of one component, and dL/d(k, mu, s). A clamped s has a gradient only if that
 * leads back inside the range. */
static void component_bits(float weight, const float *mask, const float *k_mu, const float *s,
                           float *d_symbol, float *d_mu, float *d_s, float *gathered)
{
    float bits[TED4_LANES], d_u[TED4_LANES], d_raw[TED4_LANES];

    TED4_LEVELED(ted4_rate_row)(k_mu, s, bits, d_u, d_raw);
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

/* Adds the bits of type t to those of the visible block's anchors; offsets have rows of their own.
 * total: the bits, if the type is coded for every anchor in use. */
static void tell_lanes(const ted4_rate_job *job, const ted4_rate_block *s, size_t visible, int t,
                       const float *total)
{
    const size_t K = job->in->layout->head.n_offsets;
    const float *bits = t == TED4_OFFSET ? s->kept_bits : t == TED4_PHI ? s->phi_bits : total;
    const float *mask = t == TED4_OFFSET ? s->kept : t == TED4_PHI ? s->dynamic : s->used;
    float *to = job->lane_bits + visible * ted4_row_floats(1 + K) +
                (t == TED4_OFFSET ? TED4_LANES : 0);

    for (size_t j = 0; j < (t == TED4_OFFSET ? ted4_row_floats(K) : TED4_LANES); j++)
        to[j] += mask[j] > 0.0f ? bits[j] : 0.0f;
}

static void type_bits(const ted4_rate_job *job, ted4_rate_workspace *workspace, size_t i,
                      size_t visible, int t)
{
    const ted4_shape *shape = &job->in->layout->shape;
    const size_t out = i * ted4_row_floats(shape->n_outputs) +
                       ted4_row_floats(shape->first_output[t]);
    const size_t dim = shape->dim[t], s_rows = ted4_row_floats(dim);
    const float *mu = workspace->hyper.x[job->rate->hyper.n] + out;
    float *d_mu = workspace->hyper.d[job->rate->hyper.n] + out;
    const float *q = job->steps[visible] + ted4_row_floats((size_t)t);
    float total[TED4_LANES] = { 0 };
    ted4_rate_block *s = &workspace->current;

    for (size_t c = 0; c < dim; c++, mu += TED4_LANES, d_mu += TED4_LANES) {
        const size_t at = ted4_row_floats((size_t)job->in->layout->first[t] + c);
        float k_mu[TED4_LANES], *gathered;
        const float *mask = component_mask(s, t, c, total, &gathered);

#pragma omp simd
        for (int j = 0; j < TED4_LANES; j++)
            k_mu[j] = (s->value[at + (size_t)j] / q[j] + s->residual[at + (size_t)j]) - mu[j];
        component_bits(job->in->bit_weight, mask, k_mu, mu + s_rows, s->d_symbol + at, d_mu,
                       d_mu + s_rows, gathered);
    }
    if (job->lane_bits != NULL)
        tell_lanes(job, s, visible, t, total);
    if (t == TED4_OFFSET)
        for (size_t k = 0; k < dim / 3; k++)
            workspace->sums->bits[t] +=
                masked_sum(s->kept_bits + ted4_row_floats(k), s->kept + ted4_row_floats(k));
    else
        workspace->sums->bits[t] += t == TED4_PHI ? masked_sum(s->phi_bits, s->dynamic)
                                                  : masked_sum(total, s->used);
}

static void block_forward(const ted4_rate_job *job, ted4_rate_workspace *workspace, size_t i,
                          size_t visible)
{
    const ted4_rate *r = job->rate;
    const ted4_rate_input *in = job->in;
    const ted4_rate_net *h = &r->hyper;
    const int last = h->n - 1;
    const float *hidden = workspace->hyper.x[last] + i * ted4_row_floats((size_t)h->dim[last]);
    float *out = workspace->hyper.x[h->n] + i * ted4_row_floats((size_t)h->dim[h->n]);
    ted4_rate_block *s = &workspace->current;

    load_block(job, s, visible);
    TED4_LEVELED(ted4_dense_forward)(&h->layer[last], hidden, out, 0);
    TED4_LEVELED(ted4_residuals)
    (in->layout, in->quant, s->value, job->steps[visible], in->block[visible], in->key,
     s->residual);
    slices_forward(job, workspace, i, visible);
    if (job->integer != NULL)
        ted4_rate_integer_outputs(job, workspace, job->steps[visible], out);
    memset(s->kept_bits, 0, ted4_row_floats(in->layout->head.n_offsets) * sizeof *s->kept_bits);
    memset(s->phi_bits, 0, TED4_LANES * sizeof *s->phi_bits);
    for (int t = 0; t < TED4_TYPES; t++)
        if (ted4_rate_coded(job, t))
            type_bits(job, workspace, i, visible, t);
}

void TED4_LEVELED(ted4_rate_chunk)(const ted4_rate_job *job, ted4_rate_workspace *workspace,
                                   size_t first, size_t n)
{
    memset(workspace->sums->bits, 0, sizeof workspace->sums->bits);
    for (size_t i = 0; i < n; i++) {
        steps_forward(job, workspace, i, first + i);
        if (job->steps_only)
            continue;
        block_forward(job, workspace, i, first + i);
        if (job->d_attr != NULL)
            ted4_rate_block_backward(job, workspace, i, first + i);
    }
    if (job->d_attr != NULL && !job->steps_only)
        ted4_rate_weights_backward(job->rate, workspace, n);
}
