/* arrangement.h - the order of anchors during training. Depends on trainer.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_ARRANGEMENT_H
#define TED4_ARRANGEMENT_H

#include "trainer.h"

/* Sorts the anchors, with everything that belongs to them, so that those of a block are alike:
 * first by whether their masks of motion are shut, then by the length of their lives, then by its
 * middle, then in Morton order. A step can then leave out F_deform (ted4_mask_shut) or everything
 * (visible_blocks.h) for whole blocks. The file has another order (spec 8). Returns 0, or -1 with
 * t->message. */
int ted4_arrange_anchors(ted4_trainer *t);

#endif
