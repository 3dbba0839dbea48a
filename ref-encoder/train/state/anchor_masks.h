/* anchor_masks.h - the current masks of anchors (spec 10.2). Depends on trainer.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_ANCHOR_MASKS_H
#define TED4_ANCHOR_MASKS_H

#include "trainer.h"

/* The offset mask of anchor i as the file would hold it: bit k tells whether the Gaussian of offset
 * k is kept. 0: the anchor is left out. */
uint16_t ted4_offset_bits(const ted4_trainer *t, size_t i);
/* Would the file mark anchor i as dynamic? */
int ted4_is_dynamic(const ted4_trainer *t, size_t i);
/* The number of dynamic anchors. */
size_t ted4_count_dynamic(const ted4_trainer *t);

#endif
