/* anchor_appearance.h - what all anchors look like now, a few numbers each: for what is decided
 * about an anchor apart from any one picture. Depends on trainer.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_ANCHOR_APPEARANCE_H
#define TED4_ANCHOR_APPEARANCE_H

#include "trainer.h"

/* Of each anchor, in stage 2 as the file will hold it, at time 0 and without activation, from the
 * camera of the next training picture, or, where opacity depends on the direction, from that of
 * several at which it is most opaque: summed opacity of its offsets [n], and their mean colour by
 * opacity [n][3] (NULL: not wanted; 0 where nothing is opaque). t->visible blocks are all blocks
 * afterwards. 0, or -1 with t->message. */
int ted4_anchor_appearance(ted4_trainer *t, float *opacity, float *rgb);

#endif
