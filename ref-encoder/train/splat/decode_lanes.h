/* decode_lanes.h - shared declarations of those files of the generator that are compiled once per
 * level: loops over lanes, and layers of one visible block.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_DECODE_LANES_H
#define TED4_DECODE_LANES_H

#include "train/model/formulas.h"
#include "decode_state.h"
#include "train/math/lane_math.h"

/* chain.c: each file calls the copy of its own level. */
#define ted4_gen_chain_forward  TED4_LEVELED(ted4_gen_chain_forward)
#define ted4_gen_chain_backward TED4_LEVELED(ted4_gen_chain_backward)
#define ted4_gen_chain_weights  TED4_LEVELED(ted4_gen_chain_weights)

void ted4_gen_chain_forward(const ted4_gen_chain *c, float *planes);
/* Backpropagates through a chain. d (planes of layer outputs) holds dy of the last layer and
 * receives that of the other layers. dx receives or, if add is set, accumulates the gradient of the
 * inputs ([in][32]; NULL: not wanted). */
void ted4_gen_chain_backward(const ted4_generator *g, const ted4_gen_chain *c, float *planes,
                             float *d, float *dx, int add);
/* Adds the weight gradients of n visible blocks to grad. */
void ted4_gen_chain_weights(const ted4_generator *g, const ted4_gen_chain *c, float *planes,
                            float *d, size_t n, float *grad);

#endif
