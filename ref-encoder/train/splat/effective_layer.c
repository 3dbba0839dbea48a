/* effective_layer.c - the effective first layer of F_deform, into which everything that all anchors
 * share at one time is multiplied, and its adjoint. deform_time.c has the formulas.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "decode_state.h"

#include <string.h>

#include "math/lane_sum.h"

/* to += a x. */
static void add_scaled(size_t n, float a, const float *x, float *to)
{
#pragma omp simd
    for (size_t i = 0; i < n; i++)
        to[i] += a * x[i];
}

/* W has n_time columns, P n_time rows. */
static void make_from_bank(ted4_gen_motion *m, const float *w, const float *p)
{
    const size_t in = (size_t)m->in, n_time = (size_t)m->n_time;
    const float *b_project = p + n_time * in;

    for (int o = 0; o < m->width; o++, w += n_time) {
        float *to = m->w + (size_t)o * in;

        memset(to, 0, in * sizeof *to);
        for (size_t c = 0; c < n_time; c++) {
            const float a = w[c] * m->time[c];

            add_scaled(in, a, p + c * in, to);
            m->b[o] += a * b_project[c];
        }
    }
}

/* W has in + n_time columns. */
static void make_from_constants(ted4_gen_motion *m, const float *w)
{
    const size_t in = (size_t)m->in, n_time = (size_t)m->n_time;

    for (int o = 0; o < m->width; o++, w += in + n_time) {
        memcpy(m->w + (size_t)o * in, w, in * sizeof *w);
        m->b[o] += ted4_lane_dot(n_time, w + in, m->time);
    }
}

/* Adjoint of make_from_bank: with E the effective weights, e the bias,
 *     r_oc = sum_i dE_oi P_ci + de_o p_c,  dW_oc = z_c r_oc,  dz_c = sum_o W_oc r_oc,
 *     dP_ci = z_c sum_o W_oc dE_oi,  dp_c = z_c sum_o W_oc de_o. */
static void bank_backward(ted4_gen_motion *m, const float *w, const float *p, float *d_w,
                          float *d_p)
{
    const size_t in = (size_t)m->in, n_time = (size_t)m->n_time;
    const float *b_project = p + n_time * in, *d_b = m->d_w + (size_t)m->width * in;
    float *d_b_project = d_p + n_time * in;

    memset(m->product, 0, n_time * (in + 1) * sizeof *m->product);
    for (int o = 0; o < m->width; o++, w += n_time, d_w += n_time) {
        const float *d_row = m->d_w + (size_t)o * in;

        for (size_t c = 0; c < n_time; c++) {
            const float r = ted4_lane_dot(in, d_row, p + c * in) + d_b[o] * b_project[c];

            d_w[c] += m->time[c] * r;
            m->d_time[c] += w[c] * r;
            add_scaled(in, w[c], d_row, m->product + c * (in + 1));
            m->product[c * (in + 1) + in] += w[c] * d_b[o];
        }
    }
    for (size_t c = 0; c < n_time; c++) {
        add_scaled(in, m->time[c], m->product + c * (in + 1), d_p + c * in);
        d_b_project[c] += m->time[c] * m->product[c * (in + 1) + in];
    }
}

/* Adjoint of make_from_constants. */
static void constants_backward(ted4_gen_motion *m, const float *w, float *d_w)
{
    const size_t in = (size_t)m->in, n_time = (size_t)m->n_time;
    const float *d_b = m->d_w + (size_t)m->width * in;

    for (int o = 0; o < m->width; o++, w += in + n_time, d_w += in + n_time) {
        add_scaled(in, 1.0f, m->d_w + (size_t)o * in, d_w);
        add_scaled(n_time, d_b[o], m->time, d_w + in);
        add_scaled(n_time, d_b[o], w + in, m->d_time);
    }
}

void TED4_LEVELED(ted4_gen_make_effective)(ted4_gen_motion *m, int is_bank, const float *w,
                                           const float *p)
{
    if (is_bank)
        make_from_bank(m, w, p);
    else
        make_from_constants(m, w);
}

void TED4_LEVELED(ted4_gen_motion_backward)(ted4_generator *g, const float *net, float *d_net)
{
    ted4_gen_motion *m = &g->motion;
    const ted4_layout *l = &g->layout;
    const ted4_net_shape *deform = &l->shape.netr[TED4_NET_DEFORM];
    const size_t w = l->netr + deform->first, n_time = (size_t)m->n_time;
    const size_t p = l->netr + l->shape.netr[TED4_NET_PROJECT].first;
    const size_t n_w = ted4_layer_weights(deform, 0);
    float *d_z;

    if (l->head.motion == TED4_MOTION_NONE)
        return;
    memset(m->d_time, 0, n_time * sizeof *m->d_time);
    if (l->head.motion == TED4_MOTION_BANK)
        bank_backward(m, net + w, net + p, d_net + w, d_net + p);
    else
        constants_backward(m, net + w, d_net + w);
    add_scaled((size_t)m->width, 1.0f, m->d_w + (size_t)m->width * (size_t)m->in, d_net + w + n_w);
    if (l->head.motion == TED4_MOTION_INR)
        return;
    d_z = d_net + l->bank + m->row * n_time;
    add_scaled(n_time, 1.0f - m->mix, m->d_time, d_z);
    if (m->mix > 0.0f)
        add_scaled(n_time, m->mix, m->d_time, d_z + n_time);
}
