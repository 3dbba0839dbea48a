/* decode_lanes.h - shared declarations of those files of the generator that are compiled once per
 * level: loops over lanes, and layers of one visible block.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_DECODE_LANES_H
#define TED4_DECODE_LANES_H

#include "train/model/formulas.h"
#include "decode_state.h"
#include "train/math/lane_math.h"

/* chain.c: each file calls the copy of its own level. */
#define ted4_gen_chain_forward    TED4_LEVELED(ted4_gen_chain_forward)
#define ted4_gen_chain_backward   TED4_LEVELED(ted4_gen_chain_backward)
#define ted4_gen_chain_weights    TED4_LEVELED(ted4_gen_chain_weights)
/* view_colours.c: so too. */
#define ted4_gen_view_directions  TED4_LEVELED(ted4_gen_view_directions)
#define ted4_gen_emit_colours     TED4_LEVELED(ted4_gen_emit_colours)
#define ted4_gen_camera_backward  TED4_LEVELED(ted4_gen_camera_backward)
#define ted4_gen_colours_backward TED4_LEVELED(ted4_gen_colours_backward)

void ted4_gen_chain_forward(const ted4_gen_chain *c, float *planes);
/* Backpropagates through a chain. d (planes of layer outputs) holds dy of the last layer and
 * receives that of the other layers. dx receives or, if add is set, accumulates the gradient of the
 * inputs ([in][32]; NULL: not wanted). */
void ted4_gen_chain_backward(const ted4_generator *g, const ted4_gen_chain *c, float *planes,
                             float *d, float *dx, int add);
/* Adds the weight gradients of n visible blocks to grad. */
void ted4_gen_chain_weights(const ted4_generator *g, const ted4_gen_chain *c, float *planes,
                            float *d, size_t n, float *grad);

/* Copies n channels, with 0 in unused lanes. */
static inline void ted4_gen_copy_lanes(int n, const int32_t *on, const float *from, float *to)
{
    for (int c = 0; c < n; c++, from += TED4_LANES, to += TED4_LANES) {
#pragma omp simd
        for (int j = 0; j < TED4_LANES; j++)
            to[j] = ted4_lane_keep(on[j], from[j]);
    }
}

/* Returns whether F_deform matters for a visible block: not if the masks of motion of all anchors
 * in use are shut. */
static inline int ted4_gen_moves(const ted4_generator *g, float *planes, const int32_t *on)
{
    const float *logit = ted4_gen_channel(g, planes, g->layout.temporal_logit);
    int32_t moves = 0;

    if (g->chain[TED4_NET_DEFORM].n == 0)
        return 0;
#pragma omp simd reduction(| : moves)
    for (int j = 0; j < TED4_LANES; j++)
        moves |= on[j] & -!ted4_mask_shut(logit[j]);
    return !g->layout.head.temporal_mask || moves != 0;
}

/* spec 11.5: computes the direction from the camera to each anchor, from [3][32] to [3][32]. */
void ted4_gen_view_directions(const float *camera, const float *position, float *to);
/* spec 11.5: evaluates the colour head of a visible block, from the saved planes of its input to
 * those of colours, and copies these to its Gaussians. */
void ted4_gen_emit_colours(const ted4_generator *g, size_t visible);
/* Backpropagates the gradients of the colours of a visible block. d: planes of layer outputs;
 * d_feature: [F + 3 planes], overwritten. */
void ted4_gen_colours_backward(const ted4_generator *g, const ted4_splat_grads *gr, size_t visible,
                               const int32_t *on, float *d, float *d_feature);

/* Forward: e = (p - c) / |p - c|, and c is the camera's centre. So dc = -(de - (de e) e) / |p - c|,
 * which is added lane by lane to d_camera [3][32]. d_feature, d_moved: gradients of the heads'
 * inputs, [F + 3 planes]. */
void ted4_gen_camera_backward(const ted4_gen_job *t, size_t visible, const int32_t *on,
                              const float *d_feature, const float *d_moved, float *d_camera);

/* Sums d_camera [3][32] over the lanes. */
static inline void ted4_gen_camera_sum(const float *d_camera, float sum[3])
{
    for (int c = 0; c < 3; c++) {
        sum[c] = 0;
        for (int j = 0; j < TED4_LANES; j++)
            sum[c] += d_camera[c * TED4_LANES + j];
    }
}

#endif
