/* rate_lanes.h - shared declarations of those files of the rate model that are compiled once per
 * level.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_RATE_LANES_H
#define TED4_RATE_LANES_H

#include "train/math/rate_math.h"
#include "rate_parts.h"

/* Each file calls the copy of its own level. */
#define ted4_rate_block_backward   TED4_LEVELED(ted4_rate_block_backward)
#define ted4_rate_weights_backward TED4_LEVELED(ted4_rate_weights_backward)
#define ted4_rate_integer_steps    TED4_LEVELED(ted4_rate_integer_steps)
#define ted4_rate_integer_outputs  TED4_LEVELED(ted4_rate_integer_outputs)

/* rate_bwd.c: ted4_rate_block_backward computes the gradients of visible block i of the workspace's
 * chunk, once its bits are known. ted4_rate_weights_backward, called when all visible blocks are
 * done, computes those of the weights. */
void ted4_rate_block_backward(const ted4_rate_job *job, ted4_rate_workspace *workspace, size_t i,
                              size_t visible);
void ted4_rate_weights_backward(const ted4_rate *r, ted4_rate_workspace *workspace,
                                size_t n_visible);

/* rate_decoded.c */
void ted4_rate_integer_steps(const ted4_rate_job *job, ted4_rate_workspace *workspace,
                             size_t visible, float *v, float *q);
void ted4_rate_integer_outputs(const ted4_rate_job *job, ted4_rate_workspace *workspace,
                               const float *q, float *out);

#endif
