/* rate_decoded.c - TED4_QUANT_INTEGER: mu, sigma and steps of a visible block exactly as a decoder
 * computes them, from norm/prior.h. spec 7.3, 10.1, 10.3. The float networks still run, because
 * their ReLUs decide where gradients flow; here their outputs are replaced by those of the integer
 * networks.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "rate_lanes.h"

#include "base/bytes.h"
#include "norm/half.h"

/* Evaluates the hyperprior of a visible block. Its outputs stay in the workspace; v and the steps
 * replace those of the float network. */
void ted4_rate_integer_steps(const ted4_rate_job *job, ted4_rate_workspace *workspace,
                             size_t visible, float *v, float *q)
{
    const ted4_shape *shape = &job->in->layout->shape;
    const float *p = job->in->position[visible];
    const int32_t *out = workspace->integer + shape->first_step_output * TED4_PRIOR_BLOCK;
    uint16_t position[TED4_LANES][3];

    for (size_t j = 0; j < TED4_LANES; j++)
        for (size_t a = 0; a < 3; a++)
            position[j][a] = job->in->lanes[visible] >> j & 1
                                 ? ted4_float_to_half(p[ted4_row_floats(a) + j])
                                 : 0;
    ted4_prior_hyper(&job->integer->prior, position[0], TED4_LANES, workspace->integer);
    for (int t = 0; t < TED4_TYPES; t++, q += TED4_LANES) {
        if (shape->dim[t] == 0)
            continue;
        for (int j = 0; j < TED4_LANES; j++) {
            const int index = ted4_step_index(out[j]);

            q[j] = job->in->layout->head.step[t] * ted4_bits_float(ted4_step[index]);
            v[j] = (float)(index - 128) * (1.0f / 32.0f);
        }
        out += TED4_PRIOR_BLOCK;
        v += TED4_LANES;
    }
}

/* Adds the outputs of the slice networks for the features, whose symbols are x / q + n. v: the row
 * of the features' step size. */
static void slices(const ted4_rate_job *job, ted4_rate_workspace *workspace, const float *q,
                   const float *v)
{
    const ted4_layout *l = job->in->layout;
    const size_t f = l->shape.dim[TED4_FEATURE];
    const size_t first = ted4_row_floats((size_t)l->first[TED4_FEATURE]);
    const float *x = workspace->current.value + first;
    const float *n = workspace->current.residual + first;
    int32_t *mu = workspace->integer;
    int32_t added[2 * TED4_MAX_FEATURE * TED4_PRIOR_BLOCK];
    int16_t context[TED4_MAX_FEATURE * TED4_PRIOR_BLOCK];

    for (size_t c = 0; c < f; c++)
        for (size_t j = 0, at = ted4_row_floats(c); j < TED4_LANES; j++) {
            /* If x / q is too large for fractions, the sum may round to a number just outside the
             * range of symbols. */
            const float k = ted4_lane_round(
                ted4_lane_within(x[at + j] / q[j] + n[at + j], -32767.0f, 32767.0f));
            const int index = (int)(v[j] * 32.0f) + 128;

            context[c * TED4_PRIOR_BLOCK + j] =
                ted4_context((int16_t)k, (uint8_t)index, l->head.context_bits);
        }
    for (unsigned m = 1, known = 0; m < l->head.n_slices; m++) {
        const size_t dim = l->head.slice[m];

        known += l->head.slice[m - 1];
        ted4_prior_slice(&job->integer->prior, m, context, TED4_LANES, added);
        for (size_t c = 0; c < 2 * dim; c++) {
            int32_t *to = mu + (known + (c < dim ? c : c - dim + f)) * TED4_PRIOR_BLOCK;

            for (size_t j = 0; j < TED4_LANES; j++)
                to[j] += added[c * TED4_PRIOR_BLOCK + j];
        }
    }
}

/* In out, [P][32], replaces mu and s by the decoder's mu / 256 and (sigma index - 64) / 16. */
void ted4_rate_integer_outputs(const ted4_rate_job *job, ted4_rate_workspace *workspace,
                               const float *q, float *out)
{
    const ted4_shape *shape = &job->in->layout->shape;

    slices(job, workspace, q, out + ted4_row_floats(shape->first_step_output));
    for (int t = 0; t < TED4_TYPES; t++)
        for (size_t c = 0; c < 2 * (size_t)shape->dim[t]; c++) {
            const size_t row = shape->first_output[t] + c;
            const int32_t *from = workspace->integer + row * TED4_PRIOR_BLOCK;
            float *to = out + ted4_row_floats(row);

            for (int j = 0; j < TED4_LANES; j++)
                to[j] = c < shape->dim[t] ? (float)from[j] * 0x1p-8f
                                          : (float)(ted4_sigma_index(from[j]) - 64) * 0x1p-4f;
        }
}
