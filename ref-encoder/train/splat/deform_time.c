/* deform_time.c - computes everything that depends only on the time: bank interpolation, encoded
 * time, and the effective first layer of F_deform that results. spec 11.2 and 11.3. With z the bank
 * at a time, P and p the weights and bias of F_project, and W and b those of the first layer of
 * F_deform:
 *     bank    W (z * (P phi + p)) + b = (W diag(z) P) phi + (W diag(z) p + b)
 *     concat  W [phi, z] + b          = W_left phi + (W_right z + b)
 *     inr     the same with E(p), E(t) for phi, z
 * so only one narrow layer has to be evaluated per anchor.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "decode_state.h"
#include "train/model/formulas.h"

#include <stdlib.h>
#include <string.h>

int ted4_gen_motion_init(ted4_gen_motion *m, const ted4_layout *l)
{
    const ted4_net_shape *deform = &l->shape.netr[TED4_NET_DEFORM];
    size_t in, width, n_time;

    if (l->head.motion == TED4_MOTION_NONE)
        return 0;
    m->in = l->head.motion == TED4_MOTION_INR ? TED4_INR_POINT : l->head.phi_dim;
    m->n_time = l->head.motion == TED4_MOTION_INR ? TED4_INR_TIME : l->head.bank_dim;
    m->width = deform->dim[1];
    in = (size_t)m->in;
    width = (size_t)m->width;
    n_time = (size_t)m->n_time;
    m->time = ted4_gen_alloc(n_time);
    m->d_time = ted4_gen_alloc(n_time);
    m->w = ted4_gen_alloc(width * in);
    m->b = ted4_gen_alloc(width);
    m->d_w = ted4_gen_alloc(width * (in + 1));
    m->product = ted4_gen_alloc(n_time * (in + 1));
    return m->time != NULL && m->d_time != NULL && m->w != NULL && m->b != NULL && m->d_w != NULL &&
                   m->product != NULL
               ? 0
               : -1;
}

void ted4_gen_motion_finish(ted4_gen_motion *m)
{
    free(m->time);
    free(m->d_time);
    free(m->w);
    free(m->b);
    free(m->d_w);
    free(m->product);
}

/* spec 10.1 with 10 octaves: encodes n coordinates in Q24 as 21 n values, stride apart. */
static void encode(int n, const int32_t *x, size_t stride, float *to)
{
    for (int c = 0; c < n; c++, to += stride)
        *to = ted4_from_q12(ted4_floor_shift(x[c], 12));
    for (int octave = 0; octave < TED4_INR_OCTAVES; octave++)
        for (int c = 0; c < n; c++, to += 2 * stride) {
            const uint32_t u = (uint32_t)x[c] << (7 + octave);

            to[0] = ted4_encode_sine(u);
            to[stride] = ted4_encode_cosine(u);
        }
}

/* Computes E(p) of spec 11.3. Before the scene is final, positions need not be binary16; digits
 * below 2^-24 are cut off. */
void ted4_gen_encode_points(const float *position, float *to)
{
    for (int j = 0; j < TED4_LANES; j++) {
        int32_t x[3];

        for (int c = 0; c < 3; c++)
            x[c] = (int32_t)(position[c * TED4_LANES + j] * 0x1p24f);
        encode(3, x, TED4_LANES, to + j);
    }
}

static void encode_time(ted4_gen_motion *m, uint32_t num, uint32_t den)
{
    const int32_t x = (int32_t)(((uint64_t)num << 24) / den);

    encode(1, &x, 1, m->time);
}

/* spec 11.2: interpolates the bank at time num / den. */
static void interpolate(ted4_gen_motion *m, const ted4_layout *l, const float *bank, uint32_t num,
                        uint32_t den)
{
    const size_t dim = (size_t)m->n_time;

    m->row = ted4_bank_row(&l->head, num, den, &m->mix);
    for (size_t c = 0; c < dim; c++)
        m->time[c] = ted4_bank_value(bank + m->row * dim, dim, c, m->mix);
}

void ted4_gen_motion_make(ted4_generator *g, const ted4_generate_input *in)
{
    ted4_gen_motion *m = &g->motion;
    const ted4_layout *l = &g->layout;
    const ted4_net_shape *deform = &l->shape.netr[TED4_NET_DEFORM];
    const float *w = in->net + l->netr + deform->first;

    if (l->head.motion == TED4_MOTION_NONE)
        return;
    if (l->head.motion == TED4_MOTION_INR)
        encode_time(m, in->num, in->den);
    else
        interpolate(m, l, in->net + l->bank, in->num, in->den);
    memcpy(m->b, w + ted4_layer_weights(deform, 0), deform->dim[1] * sizeof *w);
    TED4_IN_USE(ted4_gen_make_effective)
    (m, l->head.motion == TED4_MOTION_BANK, w,
     in->net + l->netr + l->shape.netr[TED4_NET_PROJECT].first);
    ted4_dense_pack(&g->chain[TED4_NET_DEFORM].layer[0].dense, m->w, m->b);
}
