/* decode_bwd.c - adjoint of decode_fwd.c: from gradients of Gaussians to those of anchors, networks
 * and bank. Masks are straight-through: their gradient is that of sigmoid(logit), as the hard 0 or
 * 1 has none; that of a mask of motion that is shut (model.h) is 0. Positions have no gradient.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "decode_lanes.h"

#include <float.h>
#include <math.h>
#include <string.h>

/* The state of the backward pass of one visible block. */
typedef struct {
    const ted4_generator *g;
    float *planes;              /* saved by the forward pass */
    float *d;                   /* gradients of layer outputs, in planes */
    float *d_attr;              /* gradients of the block's values */
    float *d_feature, *d_moved; /* F + 3 planes each: for the inputs of heads that read f, f' */
    int32_t on[TED4_LANES];
    float d_size[6 * TED4_LANES], d_position[3 * TED4_LANES], d_active[TED4_LANES];
} block_state;

static float *d_plane(const block_state *s, int plane)
{
    return ted4_gen_plane(s->d, plane - s->g->plane.outputs);
}

/* Returns sigmoid'(logit), the gradient of a mask. */
static inline float mask_slope(float logit)
{
    const float m = ted4_lane_sigmoid(logit);

    return m * (1.0f - m);
}

/* Forward, with s the sigmoid of the scale outputs:
 *     mean = position + offset size, scale = size' s. */
static void geometry_backward(block_state *s, int k, const float *const *gr)
{
    const ted4_generator *g = s->g;
    const int first = g->layout.first[TED4_OFFSET] + 3 * k;
    const float *size = ted4_gen_plane(s->planes, g->plane.size);
    const float *offset = ted4_gen_channel(g, s->planes, first);
    const float *sigmoid = ted4_gen_plane(s->planes, g->plane.covariance + 7 * k);
    float *d_offset = ted4_gen_plane(s->d_attr, first);
    float *d_y = d_plane(s, g->plane.covariance + 7 * k);

    for (int c = 0; c < 3; c++) {
        const float *d_mean = gr[TED4_GEN_MEAN + c], *d_scale = gr[TED4_GEN_SCALE + c];
        const int row = c * TED4_LANES, row2 = row + 3 * TED4_LANES;

#pragma omp simd
        for (int j = 0; j < TED4_LANES; j++) {
            const float dm = ted4_lane_keep(s->on[j], d_mean[j]);
            const float ds = ted4_lane_keep(s->on[j], d_scale[j]);
            const float v = sigmoid[row + j];

            d_offset[row + j] = dm * size[row + j];
            s->d_position[row + j] += dm;
            s->d_size[row + j] += dm * offset[row + j];
            s->d_size[row2 + j] += ds * v;
            d_y[row + j] = ds * size[row2 + j] * v * (1.0f - v);
        }
    }
}

/* Forward: r = q / |q|, or (1, 0, 0, 0) if q is too short. So dq = (dr - (dr r) r) / |q|. */
static void rotation_backward(block_state *s, int k, const float *const *gr)
{
    const int first = s->g->plane.covariance + 7 * k + 3;
    const float *q = ted4_gen_plane(s->planes, first);
    const float *d_w = gr[TED4_GEN_ROT], *d_x = gr[TED4_GEN_ROT + 1];
    const float *d_y = gr[TED4_GEN_ROT + 2], *d_z = gr[TED4_GEN_ROT + 3];
    float *d_q = d_plane(s, first);

#pragma omp simd
    for (int j = 0; j < TED4_LANES; j++) {
        const float a = q[j], b = q[TED4_LANES + j];
        const float c = q[2 * TED4_LANES + j], d = q[3 * TED4_LANES + j];
        const float n = sqrtf(a * a + b * b + c * c + d * d);
        const int32_t live = s->on[j] & -(n >= TED4_SHORT);
        const float scale = ted4_lane_keep(live, 1.0f / n);
        const float da = ted4_lane_keep(live, d_w[j]), db = ted4_lane_keep(live, d_x[j]);
        const float dc = ted4_lane_keep(live, d_y[j]), dd = ted4_lane_keep(live, d_z[j]);
        const float along = (da * a + db * b + dc * c + dd * d) * scale * scale;

        d_q[j] = (da - along * a) * scale;
        d_q[TED4_LANES + j] = (db - along * b) * scale;
        d_q[2 * TED4_LANES + j] = (dc - along * c) * scale;
        d_q[3 * TED4_LANES + j] = (dd - along * d) * scale;
    }
}

/* If squares of q overflow, the forward pass yields r = 0 for any q, so there is no gradient. */
static void endless_rotation_backward(block_state *s, int k)
{
    const int first = s->g->plane.covariance + 7 * k + 3;
    const float *q = ted4_gen_plane(s->planes, first);
    float *d_q = d_plane(s, first);

#pragma omp simd
    for (int j = 0; j < TED4_LANES; j++) {
        const float a = q[j], b = q[TED4_LANES + j];
        const float c = q[2 * TED4_LANES + j], d = q[3 * TED4_LANES + j];
        const int32_t ends = ~-(a * a + b * b + c * c + d * d > FLT_MAX);

        for (int i = 0; i < 4; i++)
            d_q[i * TED4_LANES + j] = ted4_lane_keep(ends, d_q[i * TED4_LANES + j]);
    }
}

/* Forward: o = 2 sigmoid(2 y) - 1, opacity = mask max(o, 0) A. So do/dy = 1 - o o. */
static void opacity_backward(block_state *s, int k, const float *const *gr)
{
    const ted4_generator *g = s->g;
    const float *o = ted4_gen_plane(s->planes, g->plane.opacity + k);
    const float *active = ted4_gen_plane(s->planes, g->plane.active);
    const float *logit = ted4_gen_channel(g, s->planes, g->layout.offset_logit + k);
    const float *d_opacity = gr[TED4_GEN_OPACITY];
    const int32_t all = g->layout.head.offset_mask ? 0 : -1;
    float *d_logit = ted4_gen_plane(s->d_attr, g->layout.offset_logit + k);
    float *d_y = d_plane(s, g->plane.opacity + k);

#pragma omp simd
    for (int j = 0; j < TED4_LANES; j++) {
        const float d = ted4_lane_keep(s->on[j] & -(o[j] > 0.0f), d_opacity[j]);
        const float d_kept = ted4_lane_keep(all | -ted4_mask_on(logit[j]), d);

        d_y[j] = d_kept * active[j] * (1.0f - o[j] * o[j]);
        s->d_active[j] += d_kept * o[j];
        d_logit[j] = ted4_lane_keep(~all, d * o[j] * active[j] * mask_slope(logit[j]));
    }
}

static void splats_backward(block_state *s, const ted4_splat_grads *gr, size_t visible)
{
    const int n = s->g->layout.head.n_offsets;

    for (int k = 0; k < n; k++) {
        const size_t at = (visible * (size_t)n + (size_t)k) * TED4_LANES;
        const float *d[TED4_GEN_ARRAYS];

        for (int c = 0; c < 3; c++) {
            d[TED4_GEN_MEAN + c] = gr->mean[c] + at;
            d[TED4_GEN_SCALE + c] = gr->scale[c] + at;
        }
        for (int c = 0; c < 4; c++)
            d[TED4_GEN_ROT + c] = gr->rot[c] + at;
        d[TED4_GEN_OPACITY] = gr->opacity + at;
        geometry_backward(s, k, d);
        rotation_backward(s, k, d);
        endless_rotation_backward(s, k);
        opacity_backward(s, k, d);
    }
}

static void heads_backward(block_state *s, const ted4_gen_job *t, size_t visible)
{
    const ted4_generator *g = s->g;
    const int moves = g->chain[TED4_NET_DEFORM].n > 0;
    const size_t row = ted4_gen_view_row(g);

    if (t->in->by_view)
        memcpy(s->d_feature, t->in->view_sum + visible * row, row * sizeof(float));
    else
        ted4_gen_colours_backward(g, t->gr, visible, s->on, s->d, s->d_feature);
    ted4_gen_chain_backward(g, &g->chain[TED4_NET_OPACITY], s->planes, s->d, s->d_feature, 1);
    ted4_gen_chain_backward(g, &g->chain[TED4_NET_COVARIANCE], s->planes, s->d,
                            moves ? s->d_moved : s->d_feature, !moves);
}

/* Forward: p' = p + m y, f' = f + m y'. So d_y = m d, with d the gradient of p' or f'. */
static void deform_backward(block_state *s)
{
    const ted4_generator *g = s->g;
    const int f = g->layout.head.feature_dim;
    const float *m = ted4_gen_plane(s->planes, g->plane.moving);
    const float *y = ted4_gen_plane(s->planes, g->plane.motion);
    const float *logit = ted4_gen_channel(g, s->planes, g->layout.temporal_logit);
    float *d_y = d_plane(s, g->plane.motion);
    float *d_logit = ted4_gen_plane(s->d_attr, g->layout.temporal_logit);
    float *d_phi =
        g->layout.first[TED4_PHI] < 0 ? NULL : ted4_gen_plane(s->d_attr, g->layout.first[TED4_PHI]);
    float d_m[TED4_LANES] = { 0 };

    for (int c = 0; c < 3 + f; c++, y += TED4_LANES, d_y += TED4_LANES) {
        const float *d = c < 3 ? s->d_position + c * TED4_LANES : ted4_gen_plane(s->d_moved, c - 3);

#pragma omp simd
        for (int j = 0; j < TED4_LANES; j++) {
            d_y[j] = m[j] * d[j];
            d_m[j] += y[j] * d[j];
        }
    }
    if (g->layout.head.temporal_mask) {
#pragma omp simd
        for (int j = 0; j < TED4_LANES; j++)
            d_logit[j] = ted4_lane_keep(-!ted4_mask_shut(logit[j]), d_m[j] * mask_slope(logit[j]));
    }
    ted4_gen_chain_backward(g, &g->chain[TED4_NET_DEFORM], s->planes, s->d, d_phi, 0);
}

static void feature_backward(block_state *s)
{
    const ted4_generator *g = s->g;
    const int n = g->layout.head.feature_dim * TED4_LANES;
    const int moves = g->chain[TED4_NET_DEFORM].n > 0;
    float *d = ted4_gen_plane(s->d_attr, g->layout.first[TED4_FEATURE]);

#pragma omp simd
    for (int j = 0; j < n; j++)
        d[j] = s->d_feature[j] + (moves ? s->d_moved[j] : 0.0f);
}

/* Forward: S = 2^l or max(l, 2^-20). Values below that minimum receive only gradients that lead
 * back to it. */
static void sizes_backward(block_state *s)
{
    const ted4_generator *g = s->g;
    const float *size = ted4_gen_plane(s->planes, g->plane.size);
    const float *l = ted4_gen_channel(g, s->planes, g->layout.first[TED4_SCALING]);
    const int linear = g->layout.head.scale_domain == TED4_SCALE_LINEAR;
    float *d = ted4_gen_plane(s->d_attr, g->layout.first[TED4_SCALING]);

#pragma omp simd
    for (int j = 0; j < 6 * TED4_LANES; j++) {
        const float slope = size[j] * TED4_LN2;

        d[j] = linear ? ted4_inward(l[j], TED4_SHORT, INFINITY, s->d_size[j])
                      : s->d_size[j] * slope;
    }
}

/* Forward: u = (t - a) / b, b = max(2^tau, TED4_EDGE_MIN), A = exp(-u u). So dA/da = 2 u A / b and
 * dA/db = 2 u u A / b. */
static void activation_backward(block_state *s, const ted4_generate_input *in)
{
    const ted4_generator *g = s->g;
    const float t = (float)in->num / (float)in->den;
    const float *active = ted4_gen_plane(s->planes, g->plane.active);
    const float *tau;
    float *d;

    if (!ted4_gen_activated(g, in))
        return;
    tau = ted4_gen_channel(g, s->planes, g->layout.first[TED4_TAU]);
    d = ted4_gen_plane(s->d_attr, g->layout.first[TED4_TAU]);
#pragma omp simd
    for (int j = 0; j < TED4_LANES; j++) {
        const ted4_edge e = ted4_find_edge(t, tau + j, ted4_lane_pow2);
        const float d_u = 2.0f * e.u * active[j] * s->d_active[j];
        const float d_at = d_u / e.width;
        const float d_log = e.width > TED4_EDGE_MIN ? d_u * e.u * TED4_LN2 : 0.0f;

        d[j] = ted4_lane_keep(-(e.side < 0), d_at);
        d[TED4_LANES + j] = ted4_lane_keep(-(e.side < 0), d_log);
        d[2 * TED4_LANES + j] = ted4_lane_keep(-(e.side > 0), d_at);
        d[3 * TED4_LANES + j] = ted4_lane_keep(-(e.side > 0), d_log);
    }
}

/* Backpropagates one visible block. d: memory for gradients of the planes of layer outputs;
 * d_inputs: memory for those of the heads' inputs; d_camera [3][32]: the gradient of the camera's
 * centre is added to it, lane by lane. */
static void backward_block(const ted4_gen_job *t, size_t visible, float *d, float *d_inputs,
                           float *d_camera)
{
    const ted4_layout *l = &t->g->layout;
    block_state s;

    memset(&s, 0, sizeof s);
    s.g = t->g;
    s.planes = ted4_gen_saved(t->g, visible);
    s.d = d;
    s.d_attr = t->d_attr[visible];
    s.d_feature = d_inputs;
    s.d_moved = ted4_gen_plane(d_inputs, l->head.feature_dim + 3);
    ted4_lane_set(t->in->lanes[visible], s.on);
    memset(s.d_attr, 0, (size_t)l->n_channels * TED4_LANES * sizeof *s.d_attr);
    splats_backward(&s, t->gr, visible);
    heads_backward(&s, t, visible);
    if (!t->in->by_view)
        ted4_gen_camera_backward(t, visible, s.on, s.d_feature, s.d_moved, d_camera);
    if (ted4_gen_moves(t->g, s.planes, s.on))
        deform_backward(&s);
    feature_backward(&s);
    sizes_backward(&s);
    activation_backward(&s, t->in);
}

static int block_moves(const ted4_gen_job *t, size_t visible)
{
    int32_t on[TED4_LANES];

    ted4_lane_set(t->in->lanes[visible], on);
    return ted4_gen_moves(t->g, ted4_gen_saved(t->g, visible), on);
}

/* Adds the weight gradients of a network over the visible blocks from to to - 1; d: gradients of
 * their layer outputs. F_deform has them where something moves only. */
static void weights_backward(const ted4_gen_job *t, int net, size_t from, size_t to, float *d,
                             float *grad)
{
    const ted4_generator *g = t->g;
    size_t end;

    for (size_t i = from; i < to; i = end) {
        const int some = net != TED4_NET_DEFORM || block_moves(t, i);

        for (end = i + 1; end < to; end++)
            if (net == TED4_NET_DEFORM && block_moves(t, end) != some)
                break;
        if (some)
            ted4_gen_chain_weights(g, &g->chain[net], ted4_gen_saved(g, i),
                                   d + (i - from) * g->d_size, end - i, grad);
    }
}

void TED4_LEVELED(ted4_gen_backward)(void *arg, size_t k)
{
    const ted4_gen_job *t = arg;
    ted4_generator *g = t->g;
    const size_t chunk = t->first + k;
    const size_t first = ted4_gen_first(t->in->n_visible, chunk);
    const size_t n = ted4_gen_first(t->in->n_visible, chunk + 1) - first;
    const size_t n_groups = (n + TED4_GEN_GROUP - 1) / TED4_GEN_GROUP;
    float *d = g->d_planes + chunk * g->d_chunk, *grad = g->grad + chunk * g->n_grad;
    float d_camera[3 * TED4_LANES] = { 0 };

    memset(grad, 0, g->n_grad * sizeof *grad);
    for (size_t i = 0; i < n_groups; i++) {
        const size_t from = first + n * i / n_groups;
        const size_t to = first + n * (i + 1) / n_groups;

        for (size_t visible = from; visible < to; visible++)
            backward_block(t, visible, d + (visible - from) * g->d_size,
                           d + TED4_GEN_GROUP * g->d_size, d_camera);
        for (int net = 0; net < TED4_NETS_R; net++)
            if (net != TED4_NET_COLOUR || !t->in->by_view)
                weights_backward(t, net, from, to, d, grad);
    }
    ted4_gen_camera_sum(d_camera, g->d_camera[chunk]);
}

/* Sums one range of the gradient arrays over the chunks, in their order. */
void TED4_LEVELED(ted4_gen_sum_range)(void *arg, size_t range)
{
    const ted4_gen_job *t = arg;
    ted4_generator *g = t->g;
    const size_t from = g->n_grad * range / TED4_GEN_CHUNKS;
    const size_t to = g->n_grad * (range + 1) / TED4_GEN_CHUNKS;
    float *sum = g->grad;

    for (int c = 1; c < TED4_GEN_CHUNKS; c++) {
        const float *grad = g->grad + (size_t)c * g->n_grad;

#pragma omp simd
        for (size_t i = from; i < to; i++)
            sum[i] += grad[i];
    }
}
