/* short_lived.h - finds, by colour and before training starts, the initial points that exist only
 * for a while.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_SHORT_LIVED_H
#define TED4_SHORT_LIVED_H

#include "train/state/trainer.h"

/* A point cloud made from several frames contains points of objects that have moved on since. As
 * static anchors they would be wrong in most frames and would fade away before activation is
 * learnt, and every trace of fast motion with them. So an anchor starts with its activation limited
 * to a span if, in some frames, at least half of the cameras see its colour at its place, while in
 * most other frames clearly fewer do, or in some frames hardly any (ted4_photo_votes_span). Needs
 * TED4_CAMERAS_NEEDED cameras in some frame, and activation; reads no picture without them. most >=
 * 1: number of anchors looked at together, for which all pictures are read once; no result depends
 * on it. Returns 0, or -1 with t->message filled. */
int ted4_init_short_lived(ted4_trainer *t, size_t most);

/* Returns whether anchor i was given such a span. */
int ted4_is_short_lived(const ted4_trainer *t, size_t i);

#endif
