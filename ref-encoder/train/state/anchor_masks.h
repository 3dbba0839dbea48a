/* anchor_masks.h - what the masks of anchors say at present: spec 10.2. Depends on trainer.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_ANCHOR_MASKS_H
#define TED4_ANCHOR_MASKS_H

#include "trainer.h"

/* Which Gaussians of anchor i the file would have: bit k that of offset k; 0: the anchor is left
 * out. */
uint16_t ted4_offset_bits(const ted4_trainer *t, size_t i);
/* Would the file say that anchor i moves? */
int ted4_is_dynamic(const ted4_trainer *t, size_t i);
/* Of how many? */
size_t ted4_count_dynamic(const ted4_trainer *t);

#endif
