/* anchor_appearance.h - opacity and colour of every anchor as it is now, for decisions about an
 * anchor that do not depend on any one picture. Depends on trainer.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_ANCHOR_APPEARANCE_H
#define TED4_ANCHOR_APPEARANCE_H

#include "trainer.h"

/* Computes, for each anchor, the summed opacity of its Gaussians, opacity [n], and their mean
 * colour weighted by opacity, rgb [n][3] (NULL: not wanted; 0 where nothing is opaque). Anchors are
 * evaluated at time 0 and without activation, in stage 2 as the file will hold them, from the
 * camera of the first training picture in the current order. If opacity depends on the view
 * direction, several cameras are tried, and the one that gives the anchor its highest opacity
 * counts. Afterwards t->visible_blocks holds all blocks. Returns 0, or -1 with t->message. */
int ted4_anchor_appearance(ted4_trainer *t, float *opacity, float *rgb);

#endif
