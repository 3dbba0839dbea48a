/* mv_seed.h - new anchors where several cameras at one time agree about something that the model
 * does not show. Growth splits what is there, so something fast that no initial point stands for
 * never gets an anchor: its error pulls at the background, which is right at every other time. The
 * places are found as in plane sweeping: for pixels with a large error, depths are tried along the
 * ray, and the colour has to be found, with a large error, where other cameras of that time see the
 * point. Where cameras alternate, those of the times around it look, too (alternating_cameras.h).
 * Not in the paper; needs three training cameras at a time or around it, and activation. Depends on
 * trainer.h, photo_votes.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_MV_SEED_H
#define TED4_MV_SEED_H

#include "train/state/trainer.h"

/* How many frames around a frame are searched with it (ted4_alternating_reach); -1: there is no
 * activation, or there are not enough cameras. */
int ted4_mv_seed_reach(const ted4_trainer *t);

/* All frames are searched, and anchors added at the surest places until max_anchors is reached,
 * each with the activation of the times at which its colour is seen there, and the features of the
 * anchor whose colour comes nearest. 0, or -1 with t->message. */
int ted4_mv_seed(ted4_trainer *t);

#endif
