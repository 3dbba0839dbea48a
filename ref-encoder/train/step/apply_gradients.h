/* apply_gradients.h - the optimiser's step: Adam for anchors, networks and colour maps of cameras.
 * Depends on trainer.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_APPLY_GRADIENTS_H
#define TED4_APPLY_GRADIENTS_H

#include "train/state/trainer.h"

/* Adds the gradients of the mask losses to those of t->visible blocks, then one step of Adam for
 * the anchors of t->visible blocks and for the networks; the sizes of the gradients are in
 * t->visible blocks.squares. */
void ted4_update_parameters(ted4_trainer *t);

/* One step of Adam for this camera on L + penalty (sum of A^2 and v^2), gradient being dL/d(map),
 * then ted4_colour_centre. */
void ted4_colour_update(ted4_colour *c, uint32_t camera, const ted4_colour_map gradient,
                        double rate, double penalty);

#endif
