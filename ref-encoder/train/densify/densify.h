/* densify.h - growth and pruning of anchors. Source: paper, "Preliminary: ScaffoldGS", with the
 * opacity taken after activation ("Progressive 3D-to-4D Anchor Transformation"); annex D.1. Depends
 * on trainer.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_DENSIFY_H
#define TED4_DENSIFY_H

#include "train/state/trainer.h"

/* Adds the statistics of one training step of one view. */
void ted4_densify_gather(ted4_trainer *t, const ted4_generate_input *in, const ted4_splats *s);
/* Returns the floats of the statistics of one view of several, for each visible block. */
size_t ted4_densify_per_block(const ted4_trainer *t);
/* Computes the statistics of one view of several, to[t->visible_blocks.n][per block]. */
void ted4_densify_view(ted4_trainer *t, const ted4_generate_input *in, const ted4_splats *s,
                       float *to);
/* Adds the sum over the views of a step of what ted4_densify_view has computed. */
void ted4_densify_add(ted4_trainer *t, const float *sum);
/* Grows by at most room anchors, then prunes. Returns 0, or -1 with t->message filled. */
int ted4_densify_adjust(ted4_trainer *t, size_t room);
/* Returns a mask of the lanes of a visible block whose activation at the query time is at least a
 * half. */
uint32_t ted4_lanes_there(const ted4_generate_input *in, size_t visible);

#endif
