/* mv_seed.h - multi-view seeding: new anchors where several cameras agree, within one frame, about
 * something that the model fails to render. Growth splits only existing anchors, so a fast object
 * without an initial point never gets an anchor: its error acts on the background, which is correct
 * in all other frames. Candidate places are found by plane sweeping: for each pixel with a large
 * error, depths along its ray are tried, and other cameras of the frame that see the point must
 * show the same colour, also with a large error. This is not in the paper.
 * If no frame has three training cameras, single-view seeding acts instead (sv_seed.h). Depends on
 * trainer.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_MV_SEED_H
#define TED4_MV_SEED_H

#include "train/state/trainer.h"

/* Returns whether multi-view seeding applies to the scene: there is activation, and some frame has
 * TED4_CAMERAS_NEEDED training pictures (photo_votes.h). */
int ted4_mv_seed_applies(const ted4_trainer *t);

/* Searches all frames and adds anchors, most reliable places first, until max_anchors is reached.
 * If that leaves too few for all places, new anchors are wider than places are apart: by the
 * largest power of two, up to 32, at which all of them are still used. Each new anchor is active in
 * the frames in which its colour is seen at its place, and takes the features of the anchor with
 * the nearest colour. Returns 0, or -1 with t->message filled. */
int ted4_mv_seed(ted4_trainer *t);

#endif
