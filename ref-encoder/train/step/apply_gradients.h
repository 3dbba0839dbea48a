/* apply_gradients.h - the step of the optimiser: Adam for anchors, networks and colour maps of
 * cameras. Depends on trainer.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_APPLY_GRADIENTS_H
#define TED4_APPLY_GRADIENTS_H

#include "train/state/trainer.h"

/* Adds the gradients of the mask losses to those of t->visible_blocks, then does one step of Adam
 * for the anchors of t->visible_blocks and for the networks. n_views: views whose mean the
 * gradients are; learning rates grow with its square root (Grendel-GS: Adam's steps then average
 * out as over as many steps of one view). t->visible_blocks.squares receives the sizes of the
 * gradients. */
void ted4_update_parameters(ted4_trainer *t, size_t n_views);

/* Does one step of Adam for this camera on L + penalty (sum of A^2 and v^2), and then
 * ted4_colour_centre; and likewise for its exposures, if there are any, whose squared second
 * differences count, too. gradient is dL/d(map of ted4_colour_at). */
void ted4_colour_update(ted4_colour *c, uint32_t camera, uint32_t frame,
                        const ted4_colour_map gradient, double rate, double penalty);

#endif
