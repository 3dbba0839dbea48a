/* rate_bwd.c - adjoint of rate.c, one visible block at a time; gradients of weights are computed
 * once per chunk. spec 7.3, 9.4, 10. The forward pass is, for a value x of a type with q = Q0 2^v,
 *     k = x / q + n,  bits(k - mu, s),  context = (x + q n) / Q0,  rendered value = x + q n
 * with the residual n held constant. So dk/dx = 1/q, dk/dv = -(x/q) ln 2, d(context)/dx = 1/Q0 and
 * d(x + q n)/dv = q n ln 2. The trainer adds the gradient of x that comes from the rendered value.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "rate_lanes.h"

#include <string.h>

/* The outputs of the slice networks were added to those of the hyperprior, so both have the same
 * gradients of mu and s. */
static void slices_backward(const ted4_rate *r, ted4_rate_workspace *workspace, size_t i)
{
    const ted4_layout *l = &r->layout;
    const size_t f = l->shape.dim[TED4_FEATURE];
    const float *d_out = workspace->hyper.d[r->hyper.n] + i * ted4_row_floats(l->shape.n_outputs) +
                         ted4_row_floats(l->shape.first_output[TED4_FEATURE]);

    memset(workspace->current.d_context, 0, ted4_row_floats(f) * sizeof(float));
    for (size_t m = 1, known = 0; m < l->head.n_slices; m++) {
        const ted4_rate_net *n = &r->slice[m];
        const size_t width = ted4_row_floats((size_t)n->dim[1]);
        const size_t half = ted4_row_floats(l->head.slice[m]);
        float *d_hidden = workspace->slice[m].d[1] + i * width;
        float *d_y = workspace->slice[m].d[2] + i * ted4_row_floats((size_t)n->dim[2]);

        known += l->head.slice[m - 1];
        memcpy(d_y, d_out + ted4_row_floats(known), half * sizeof *d_y);
        memcpy(d_y + half, d_out + ted4_row_floats(known + f), half * sizeof *d_y);
        TED4_LEVELED(ted4_dense_backward_x)(&n->layer[1], d_y, d_hidden, 0);
        ted4_relu_backward(workspace->slice[m].x[1] + i * width, width, d_hidden);
        TED4_LEVELED(ted4_dense_backward_x)
        (&n->layer[0], d_hidden, workspace->current.d_context, 1);
    }
}

/* Adds dL/dx of one component to d_x, and dL/d(v ln 2) to d_v. d_context and d_value may be NULL.
 * d_value is read before d_x is written, as both may be the same row. */
static void value_backward(const ted4_rate_job *job, const ted4_rate_block *s, int t,
                           size_t channel, const float *q, const float *d_context,
                           const float *d_value, const int32_t *on, float *d_x, float *d_v)
{
    const size_t at = ted4_row_floats(channel);
    const float unit = 1.0f / job->in->layout->head.step[t];
    const float distortion = job->in->distortion_weight;
    const float *x = s->value + at, *n = s->residual + at;
    const float *d_k = s->d_symbol + at;

    if (d_value != NULL) {
#pragma omp simd
        for (int j = 0; j < TED4_LANES; j++)
            d_v[j] += ted4_lane_keep(on[j], distortion * d_value[at + (size_t)j] * q[j] * n[j]);
    }
#pragma omp simd
    for (int j = 0; j < TED4_LANES; j++) {
        d_x[j] += d_k[j] / q[j];
        d_v[j] -= d_k[j] * (x[j] / q[j]);
    }
    if (d_context != NULL) {
#pragma omp simd
        for (int j = 0; j < TED4_LANES; j++) {
            d_x[j] += d_context[j] * unit;
            d_v[j] += d_context[j] * unit * q[j] * n[j];
        }
    }
}

static void type_backward(const ted4_rate_job *job, ted4_rate_workspace *workspace, size_t visible,
                          int t, const float *v, float *d_v)
{
    const ted4_layout *l = job->in->layout;
    const float *q = job->steps[visible] + ted4_row_floats((size_t)t);
    const float *d_value = job->d_value != NULL ? job->d_value[visible] : NULL;
    const float *d_context = t == TED4_FEATURE ? workspace->current.d_context : NULL;
    int32_t on[TED4_LANES];

    ted4_lane_set(job->in->lanes[visible], on);
    for (size_t c = 0; c < l->shape.dim[t]; c++) {
        const size_t channel = (size_t)l->first[t] + c;

        value_backward(job, &workspace->current, t, channel, q, d_context, d_value, on,
                       job->d_attr[visible] + ted4_row_floats(channel), d_v);
        d_context = d_context != NULL ? d_context + TED4_LANES : NULL;
    }
#pragma omp simd
    for (int j = 0; j < TED4_LANES; j++)
        d_v[j] = ted4_inward(v[j], TED4_V_MIN, TED4_V_MAX, d_v[j] * TED4_LN2);
}

/* Straight-through estimator: bits are weighted by the sigmoid of the logit. */
static void mask_backward(float weight, const float *bits, const int32_t *on, const float *logit,
                          float *d_logit)
{
#pragma omp simd
    for (int j = 0; j < TED4_LANES; j++) {
        const float m = ted4_lane_sigmoid(logit[j]);

        d_logit[j] += ted4_lane_keep(on[j], weight * bits[j] * m * (1.0f - m));
    }
}

static void logits_backward(const ted4_rate_job *job, const ted4_rate_block *s, size_t visible)
{
    const ted4_layout *l = job->in->layout;
    const float weight = job->in->bit_weight;
    const float *attr = job->in->attr[visible];
    float *d = job->d_attr[visible];
    int32_t in_use[TED4_LANES], used[TED4_LANES];
    const size_t moves = ted4_row_floats((size_t)l->temporal_logit);

    ted4_lane_set(job->in->lanes[visible], in_use);
    for (int j = 0; j < TED4_LANES; j++)
        used[j] = -(s->used[j] > 0.0f);
    for (size_t k = 0; l->head.offset_mask && k < l->head.n_offsets; k++) {
        const size_t at = ted4_row_floats((size_t)l->offset_logit + k);

        mask_backward(weight, s->kept_bits + ted4_row_floats(k), in_use, attr + at, d + at);
    }
    if (l->head.temporal_mask)
        mask_backward(weight, s->phi_bits, used, attr + moves, d + moves);
}

static void hyper_backward(const ted4_rate *r, ted4_rate_workspace *workspace, size_t i)
{
    const ted4_rate_net *h = &r->hyper;
    const ted4_rate_acts *a = &workspace->hyper;
    const float *d_v = a->d[h->n] + i * ted4_row_floats((size_t)h->dim[h->n]) +
                       ted4_row_floats(r->layout.shape.first_step_output);

    for (int k = h->n - 1; k > 0; k--) {
        const size_t width = ted4_row_floats((size_t)h->dim[k]);
        float *d = a->d[k] + i * width;

        TED4_LEVELED(ted4_dense_backward_x)
        (&h->layer[k], a->d[k + 1] + i * ted4_row_floats((size_t)h->dim[k + 1]), d, 0);
        if (k == h->n - 1)
            TED4_LEVELED(ted4_dense_backward_x)(&r->step, d_v, d, 1);
        ted4_relu_backward(a->x[k] + i * width, width, d);
    }
}

void ted4_rate_block_backward(const ted4_rate_job *job, ted4_rate_workspace *workspace, size_t i,
                              size_t visible)
{
    const ted4_rate *r = job->rate;
    const ted4_shape *shape = &r->layout.shape;
    const size_t out = i * ted4_row_floats(shape->n_outputs);
    const size_t steps = out + ted4_row_floats(shape->first_step_output);
    const float *v = workspace->hyper.x[r->hyper.n] + steps;
    float *d_out = workspace->hyper.d[r->hyper.n];
    float *d_v = d_out + steps;

    memset(d_v, 0, ted4_row_floats(shape->n_types) * sizeof *d_v);
    slices_backward(r, workspace, i);
    for (int t = 0; t < TED4_TYPES; t++) {
        if (shape->dim[t] == 0)
            continue;
        if (ted4_rate_coded(job, t))
            type_backward(job, workspace, visible, t, v, d_v);
        else
            memset(d_out + out + ted4_row_floats(shape->first_output[t]), 0,
                   ted4_row_floats(2 * (size_t)shape->dim[t]) * sizeof *d_out);
        v += TED4_LANES;
        d_v += TED4_LANES;
    }
    logits_backward(job, &workspace->current, visible);
    hyper_backward(r, workspace, i);
}

/* Computes the gradients of layer k's weights over all visible blocks. x: the layer's inputs. */
static void layer_weights(const ted4_rate_net *n, int k, const float *x, size_t x_stride,
                          const float *d, size_t n_visible, float *d_net)
{
    TED4_LEVELED(ted4_dense_backward_w)
    (n->dim[k], n->dim[k + 1], x, x_stride, d, ted4_row_floats((size_t)n->dim[k + 1]), n_visible,
     d_net + n->w[k], d_net + n->b[k]);
}

void ted4_rate_weights_backward(const ted4_rate *r, ted4_rate_workspace *workspace,
                                size_t n_visible)
{
    const ted4_layout *l = &r->layout;
    const size_t context = ted4_row_floats(l->shape.dim[TED4_FEATURE]);
    float *d_net = workspace->sums->d_net;

    memset(d_net, 0, l->shape.n_nete * sizeof *d_net);
    for (int k = 0; k < r->hyper.n; k++)
        layer_weights(&r->hyper, k, workspace->hyper.x[k], ted4_row_floats((size_t)r->hyper.dim[k]),
                      workspace->hyper.d[k + 1], n_visible, d_net);
    for (int m = 1; m < l->head.n_slices; m++) {
        const ted4_rate_net *n = &r->slice[m];
        const ted4_rate_acts *a = &workspace->slice[m];

        layer_weights(n, 0, workspace->context, context, a->d[1], n_visible, d_net);
        layer_weights(n, 1, a->x[1], ted4_row_floats((size_t)n->dim[1]), a->d[2], n_visible, d_net);
    }
}
