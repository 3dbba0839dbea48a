/* decode_lanes.h - what the generator's files that are compiled once a level share: loops over
 * lanes, and layers of one visible block.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_DECODE_LANES_H
#define TED4_DECODE_LANES_H

#include "train/model/formulas.h"
#include "decode_state.h"
#include "train/math/lane_math.h"

/* chain.c: a file calls the copy of its own level. */
#define ted4_gen_chain_forward  TED4_LEVELED(ted4_gen_chain_forward)
#define ted4_gen_chain_backward TED4_LEVELED(ted4_gen_chain_backward)
#define ted4_gen_chain_weights  TED4_LEVELED(ted4_gen_chain_weights)

void ted4_gen_chain_forward(const ted4_gen_chain *c, float *planes);
/* dy of the last layer is set in d (planes of layer outputs); fills those of the others, and dx
 * ([in][32], NULL: not wanted). */
void ted4_gen_chain_backward(const ted4_generator *g, const ted4_gen_chain *c, float *planes,
                             float *d, float *dx, int add);
/* Adds the weight gradients of n visible blocks to grad. */
void ted4_gen_chain_weights(const ted4_generator *g, const ted4_gen_chain *c, float *planes,
                            float *d, size_t n, float *grad);

#endif
