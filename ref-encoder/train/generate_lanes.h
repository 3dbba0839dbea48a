/* generate_lanes.h - what the generator's files that are compiled once a level share: loops over
 * lanes, and layers of one slot.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_GENERATE_LANES_H
#define TED4_GENERATE_LANES_H

#include "generate_state.h"
#include "lane_math.h"

/* generate_chain.c: a file calls the copy of its own level. */
#define ted4_gen_chain_forward  TED4_LEVELED(ted4_gen_chain_forward)
#define ted4_gen_chain_backward TED4_LEVELED(ted4_gen_chain_backward)
#define ted4_gen_chain_weights  TED4_LEVELED(ted4_gen_chain_weights)

void ted4_gen_chain_forward(const ted4_gen_chain *c, float *planes);
/* dy of the last layer is set in d (planes of layer outputs); fills those of the others, and dx
 * ([in][32], NULL: not wanted). */
void ted4_gen_chain_backward(const ted4_generator *g, const ted4_gen_chain *c, float *planes,
                             float *d, float *dx, int add);
/* Adds the weight gradients of n slots to grad. */
void ted4_gen_chain_weights(const ted4_generator *g, const ted4_gen_chain *c, float *planes,
                            float *d, size_t n, float *grad);

/* spec 11.4 for one lane: the edge that t lies beyond (side -1: before the start, 1: after the end,
 * 0: neither), and u. */
typedef struct {
    int   side;
    float width, u;
} ted4_gen_edge;

static inline ted4_gen_edge ted4_gen_find_edge(float t, const float *tau)
{
    const float start = tau[0], start_width = tau[TED4_LANES];
    const float end = tau[2 * TED4_LANES], end_width = tau[3 * TED4_LANES];
    const int side = t < start ? -1 : t > end;
    const float at = side < 0 ? start : end;
    const float b = ted4_lane_pow2(side < 0 ? start_width : end_width);
    const float width = b > TED4_EDGE_MIN ? b : TED4_EDGE_MIN;
    const ted4_gen_edge e = { side, width, side != 0 ? (t - at) / width : 0.0f };

    return e;
}

#endif
