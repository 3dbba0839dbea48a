/* decode_fwd.c - turns anchors into Gaussians for one time and one camera centre, one visible block
 * at a time (spec 11.1 to 11.5, in normalised space), with the masks of training. The adjoint is
 * decode_bwd.c.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "decode_lanes.h"

#include <math.h>
#include <string.h>

static void load_block(ted4_generator *g, const ted4_generate_input *in, size_t visible,
                       const float *position, const int32_t *on)
{
    const int f = g->layout.head.feature_dim;
    const float *attr = in->attr[visible];
    float *planes = ted4_gen_saved(g, visible);

    ted4_gen_copy_lanes(f, on, attr, ted4_gen_plane(planes, g->plane.feature));
    ted4_gen_copy_lanes(g->layout.n_channels - f, on, attr + (size_t)f * TED4_LANES,
                        ted4_gen_plane(planes, g->plane.rest));
    if (g->plane.view >= 0)
        ted4_gen_view_directions(in->camera, position, ted4_gen_plane(planes, g->plane.view));
    if (g->plane.point >= 0)
        ted4_gen_encode_points(position, ted4_gen_plane(planes, g->plane.point));
}

/* spec 11.1: computes S from the six scaling values. */
static void sizes(const ted4_generator *g, float *planes)
{
    const float *l = ted4_gen_channel(g, planes, g->layout.first[TED4_SCALING]);
    float *s = ted4_gen_plane(planes, g->plane.size);
    const int n = 6 * TED4_LANES;

    if (g->layout.head.scale_domain == TED4_SCALE_LOG2) {
#pragma omp simd
        for (int j = 0; j < n; j++)
            s[j] = ted4_lane_pow2(l[j]);
    } else {
#pragma omp simd
        for (int j = 0; j < n; j++)
            s[j] = l[j] > TED4_SHORT ? l[j] : TED4_SHORT;
    }
}

/* spec 11.3: computes f' = f + m df and the moved position p + m dx, which replaces position.
 * moves: ted4_gen_moves. */
static void deform(ted4_generator *g, float *planes, float *position, int moves)
{
    const int f = g->layout.head.feature_dim;
    const float *logit = ted4_gen_channel(g, planes, g->layout.temporal_logit);
    const float *feature = ted4_gen_plane(planes, g->plane.feature);
    float *moved = ted4_gen_plane(planes, g->plane.moved);
    float *m = ted4_gen_plane(planes, g->plane.moving);
    const float *y;

    if (g->layout.head.view == TED4_VIEW_FULL)
        memcpy(moved + f * TED4_LANES, ted4_gen_plane(planes, g->plane.view),
               3 * TED4_LANES * sizeof *moved);
    if (!moves) {
        memcpy(moved, feature, (size_t)f * TED4_LANES * sizeof *moved);
        return;
    }
    ted4_gen_chain_forward(&g->chain[TED4_NET_DEFORM], planes);
    y = ted4_gen_plane(planes, g->plane.motion);
#pragma omp simd
    for (int j = 0; j < TED4_LANES; j++)
        m[j] = !g->layout.head.temporal_mask || ted4_mask_on(logit[j]) ? 1.0f : 0.0f;
    for (int c = 0; c < 3; c++, y += TED4_LANES) {
#pragma omp simd
        for (int j = 0; j < TED4_LANES; j++)
            position[c * TED4_LANES + j] += m[j] * y[j];
    }
    for (int c = 0; c < f; c++, y += TED4_LANES, feature += TED4_LANES, moved += TED4_LANES) {
#pragma omp simd
        for (int j = 0; j < TED4_LANES; j++)
            moved[j] = feature[j] + m[j] * y[j];
    }
}

/* spec 11.4: computes the activation. */
static void activation(const ted4_generator *g, const ted4_generate_input *in, float *planes)
{
    float *a = ted4_gen_plane(planes, g->plane.active);
    const float *tau;

    for (int j = 0; j < TED4_LANES; j++)
        a[j] = 1.0f;
    if (!ted4_gen_activated(g, in))
        return;
    tau = ted4_gen_channel(g, planes, g->layout.first[TED4_TAU]);
#pragma omp simd
    for (int j = 0; j < TED4_LANES; j++) {
        const float t = (float)in->num / (float)in->den;

        a[j] = ted4_activation(ted4_find_edge(t, tau + j, ted4_lane_pow2).u, ted4_lane_pow2);
    }
}

/* spec 11.5: applies 2 sigmoid(2 y) - 1 and sigmoids to the outputs of the heads of opacity and
 * covariance, in place, except for quaternions. */
static void squash(const ted4_generator *g, float *planes)
{
    const int k = g->layout.head.n_offsets;
    float *opacity = ted4_gen_plane(planes, g->plane.opacity);

#pragma omp simd
    for (int j = 0; j < k * TED4_LANES; j++)
        opacity[j] = 2.0f * ted4_lane_sigmoid(2.0f * opacity[j]) - 1.0f;
    for (int i = 0; i < k; i++) {
        float *scale = ted4_gen_plane(planes, g->plane.covariance + 7 * i);

#pragma omp simd
        for (int j = 0; j < 3 * TED4_LANES; j++)
            scale[j] = ted4_lane_sigmoid(scale[j]);
    }
}

static void emit_rotation(const float *q, float *const *out)
{
    float *w = out[0], *x = out[1], *y = out[2], *z = out[3];

#pragma omp simd
    for (int j = 0; j < TED4_LANES; j++) {
        const float a = q[j], b = q[TED4_LANES + j];
        const float c = q[2 * TED4_LANES + j], d = q[3 * TED4_LANES + j];
        const float n = sqrtf(a * a + b * b + c * c + d * d);
        const float scale = n >= TED4_SHORT ? 1.0f / n : 0.0f;

        w[j] = n >= TED4_SHORT ? a * scale : 1.0f;
        x[j] = b * scale;
        y[j] = c * scale;
        z[j] = d * scale;
    }
}

/* Writes the Gaussians of offset k of a visible block, except for colours. position: of the moved
 * anchors. */
static void emit(const ted4_generator *g, float *planes, const float *position, const int32_t *on,
                 int k, float *const *out)
{
    const float *size = ted4_gen_plane(planes, g->plane.size);
    const float *offset = ted4_gen_channel(g, planes, g->layout.first[TED4_OFFSET] + 3 * k);
    const float *logit = ted4_gen_channel(g, planes, g->layout.offset_logit + k);
    const float *covariance = ted4_gen_plane(planes, g->plane.covariance + 7 * k);
    const float *o = ted4_gen_plane(planes, g->plane.opacity + k);
    const float *active = ted4_gen_plane(planes, g->plane.active);
    const int32_t all = g->layout.head.offset_mask ? 0 : -1;
    float *opacity = out[TED4_GEN_OPACITY];

    for (int c = 0; c < 3; c++) {
        const int row = c * TED4_LANES;
        float *mean = out[TED4_GEN_MEAN + c], *scale = out[TED4_GEN_SCALE + c];

#pragma omp simd
        for (int j = 0; j < TED4_LANES; j++) {
            mean[j] = ted4_fma(offset[row + j], size[row + j], position[row + j]);
            scale[j] = size[3 * TED4_LANES + row + j] * covariance[row + j];
        }
    }
    emit_rotation(covariance + 3 * TED4_LANES, out + TED4_GEN_ROT);
#pragma omp simd
    for (int j = 0; j < TED4_LANES; j++) {
        const int32_t kept = on[j] & (all | -ted4_mask_on(logit[j])) & -(o[j] > 0.0f);

        opacity[j] = ted4_lane_keep(kept, o[j] * active[j]);
    }
}

void TED4_LEVELED(ted4_gen_forward)(void *job, size_t visible)
{
    const ted4_gen_job *t = job;
    ted4_generator *g = t->g;
    const int k = g->layout.head.n_offsets;
    float *planes = ted4_gen_saved(g, visible);
    _Alignas(64) float position[3 * TED4_LANES];
    int32_t on[TED4_LANES];

    ted4_lane_set(t->in->lanes[visible], on);
    ted4_gen_copy_lanes(3, on, t->in->position[visible], position);
    load_block(g, t->in, visible, position, on);
    sizes(g, planes);
    if (g->chain[TED4_NET_DEFORM].n > 0)
        deform(g, planes, position, ted4_gen_moves(g, planes, on));
    ted4_gen_chain_forward(&g->chain[TED4_NET_OPACITY], planes);
    ted4_gen_chain_forward(&g->chain[TED4_NET_COVARIANCE], planes);
    activation(g, t->in, planes);
    squash(g, planes);
    for (int i = 0; i < k; i++) {
        float *out[TED4_GEN_ARRAYS];

        for (int a = 0; a < TED4_GEN_ARRAYS; a++)
            out[a] = ted4_gen_splats(g, a, visible) + (size_t)i * TED4_LANES;
        emit(g, planes, position, on, i, out);
    }
    if (!t->in->by_view)
        ted4_gen_emit_colours(g, visible);
}
