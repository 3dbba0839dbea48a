/* still_anchors.h - closes the temporal masks of anchors whose motion explains nothing. The loss of
 * the temporal mask (paper, "Training Objectives"; annex D.1) charges an anchor's motion for its
 * bits at most, and noise in the gradients keeps masks open that nothing needs. But a decoder
 * deforms each anchor that moves, and evaluates its heads, again at every time, so motion is also
 * charged for that. Depends on trainer.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_STILL_ANCHORS_H
#define TED4_STILL_ANCHORS_H

#include "train/state/trainer.h"

/* Closes each dynamic anchor whose motion saves less than motion_worth / n of the loss of recent
 * steps, n being the number of anchors, and moves it to the middle of its path: the mean of its
 * positions over time, weighted by its opacity. What motion saves is estimated as the mean, over
 * training pictures, of the magnitude of the first-order change of the distortion if the anchor's
 * Gaussians were replaced by their means over time. Everything else stays as it is, and so do
 * anchors that no sampled picture shows, or whose middle lies outside the cube. t->closing receives
 * the counts. Only within stage 1; nothing happens without motion or temporal mask, or if
 * motion_worth is 0. Returns 0, or -1 with t->message filled. */
int ted4_close_still_anchors(ted4_trainer *t);

#endif
