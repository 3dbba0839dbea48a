/* view_colours.c - the part of decode_fwd.c and decode_bwd.c that depends on the camera: view
 * directions and the colour head (spec 11.5), which several views of one time need one by one.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "decode_lanes.h"

#include <math.h>
#include <string.h>

void ted4_gen_view_directions(const float *camera, const float *position, float *to)
{
#pragma omp simd
    for (int j = 0; j < TED4_LANES; j++) {
        float x = position[j] - camera[0];
        float y = position[TED4_LANES + j] - camera[1];
        float z = position[2 * TED4_LANES + j] - camera[2];

        ted4_view_direction(&x, &y, &z);
        to[j] = x;
        to[TED4_LANES + j] = y;
        to[2 * TED4_LANES + j] = z;
    }
}

void ted4_gen_emit_colours(const ted4_generator *g, size_t visible)
{
    const int k = g->layout.head.n_offsets;
    float *planes = ted4_gen_saved(g, visible);
    float *colour = ted4_gen_plane(planes, g->plane.colour);

    ted4_gen_chain_forward(&g->chain[TED4_NET_COLOUR], planes);
#pragma omp simd
    for (int j = 0; j < 3 * k * TED4_LANES; j++)
        colour[j] = ted4_lane_sigmoid(colour[j]);
    for (int i = 0; i < k; i++)
        for (int c = 0; c < 3; c++, colour += TED4_LANES)
            memcpy(ted4_gen_splats(g, TED4_GEN_COLOUR + c, visible) + (size_t)i * TED4_LANES,
                   colour, TED4_LANES * sizeof *colour);
}

void ted4_gen_colours_backward(const ted4_generator *g, const ted4_splat_grads *gr, size_t visible,
                               const int32_t *on, float *d, float *d_feature)
{
    const int n = g->layout.head.n_offsets;
    float *planes = ted4_gen_saved(g, visible);
    const float *v = ted4_gen_plane(planes, g->plane.colour);
    float *d_y = ted4_gen_plane(d, g->plane.colour - g->plane.outputs);

    for (int k = 0; k < n; k++)
        for (int c = 0; c < 3; c++, v += TED4_LANES, d_y += TED4_LANES) {
            const float *from = gr->colour[c] + (visible * (size_t)n + (size_t)k) * TED4_LANES;

#pragma omp simd
            for (int j = 0; j < TED4_LANES; j++)
                d_y[j] = ted4_lane_keep(on[j], from[j]) * v[j] * (1.0f - v[j]);
        }
    ted4_gen_chain_backward(g, &g->chain[TED4_NET_COLOUR], planes, d, d_feature, 0);
}

void ted4_gen_camera_backward(const ted4_gen_job *t, size_t visible, const int32_t *on,
                              const float *d_feature, const float *d_moved, float *d_camera)
{
    const ted4_generator *g = t->g;
    const int f = g->layout.head.feature_dim;
    const int twice = g->layout.head.view == TED4_VIEW_FULL && g->chain[TED4_NET_DEFORM].n > 0;
    const float *camera = t->in->camera, *position = t->in->position[visible];
    const float *e, *d = d_feature + f * TED4_LANES, *d2 = d_moved + f * TED4_LANES;

    if (g->plane.view < 0)
        return;
    e = ted4_gen_plane(ted4_gen_saved(g, visible), g->plane.view);
#pragma omp simd
    for (int j = 0; j < TED4_LANES; j++) {
        float de[3], along = 0, square = 0;

        for (int c = 0; c < 3; c++) {
            const float x = position[c * TED4_LANES + j] - camera[c];

            de[c] = d[c * TED4_LANES + j] + (twice ? d2[c * TED4_LANES + j] : 0.0f);
            along += de[c] * e[c * TED4_LANES + j];
            square += x * x;
        }
        const float n = sqrtf(square);
        const int32_t far = on[j] & -(n >= TED4_SHORT);

        for (int c = 0; c < 3; c++)
            d_camera[c * TED4_LANES + j] -=
                ted4_lane_keep(far, (de[c] - along * e[c * TED4_LANES + j]) / n);
    }
}

void TED4_LEVELED(ted4_gen_view_forward)(void *job, size_t visible)
{
    const ted4_gen_job *t = job;
    ted4_generator *g = t->g;
    const int k = g->layout.head.n_offsets;
    const size_t at = visible * (size_t)k * TED4_LANES;
    const float *opacity = ted4_gen_splats(g, TED4_GEN_OPACITY, visible);
    _Alignas(64) float position[3 * TED4_LANES];
    int32_t on[TED4_LANES];

    ted4_lane_set(t->in->lanes[visible], on);
    for (int i = 0; i < k; i++)
        ted4_gen_copy_lanes(1, on, opacity + i * TED4_LANES, g->shown + at + i * TED4_LANES);
    if (g->plane.view >= 0) {
        ted4_gen_copy_lanes(3, on, t->in->position[visible], position);
        ted4_gen_view_directions(t->in->camera, position,
                                 ted4_gen_plane(ted4_gen_saved(g, visible), g->plane.view));
    }
    ted4_gen_emit_colours(g, visible);
}

void TED4_LEVELED(ted4_gen_view_backward)(void *job, size_t chunk)
{
    const ted4_gen_job *t = job;
    ted4_generator *g = t->g;
    const size_t first = ted4_gen_first(t->in->n_visible, chunk);
    const size_t n = ted4_gen_first(t->in->n_visible, chunk + 1) - first;
    const size_t n_groups = (n + TED4_GEN_GROUP - 1) / TED4_GEN_GROUP, row = ted4_gen_view_row(g);
    float *d = g->d_planes + chunk * g->d_chunk, *grad = g->grad + chunk * g->n_grad;
    float *d_feature = d + TED4_GEN_GROUP * g->d_size;
    float d_camera[3 * TED4_LANES] = { 0 };

    memset(grad + ted4_gen_colour_grad(g), 0, ted4_gen_colour_weights(g) * sizeof *grad);
    for (size_t i = 0; i < n_groups; i++) {
        const size_t from = first + n * i / n_groups, to = first + n * (i + 1) / n_groups;

        for (size_t visible = from; visible < to; visible++) {
            int32_t on[TED4_LANES];

            ted4_lane_set(t->in->lanes[visible], on);
            ted4_gen_colours_backward(g, t->gr, visible, on, d + (visible - from) * g->d_size,
                                      d_feature);
            ted4_gen_camera_backward(t, visible, on, d_feature, d_feature, d_camera);
            memcpy(t->view_sum + visible * row, d_feature, row * sizeof *d_feature);
        }
        ted4_gen_chain_weights(g, &g->chain[TED4_NET_COLOUR], ted4_gen_saved(g, from), d, to - from,
                               grad);
    }
    ted4_gen_camera_sum(d_camera, g->d_camera[chunk]);
}
