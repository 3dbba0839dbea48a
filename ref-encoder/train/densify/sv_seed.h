/* sv_seed.h - single-view seeding: new anchors for what moves before one or two cameras. Nothing
 * triangulates such content within one frame, initial points hold what stands still only, and
 * growth splits existing anchors, so it would stay missing or a blur. Where the error of a training
 * picture stays high, single-view seeding puts an anchor on the ray of the pixel, at the depth at
 * which the least motion explains what neighbouring pictures show: pictures of the same frame and
 * of those before and after. It is active from the picture before to the picture after. This is not
 * in the paper. It needs activation, and acts only if no frame has as
 * many cameras as multi-view seeding needs (mv_seed.h), and if the pictures are taken from at least
 * as many distinct viewpoints. Depends on trainer.h, plane_sweep.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_SV_SEED_H
#define TED4_SV_SEED_H

#include "plane_sweep.h"

/* Returns whether single-view seeding applies to the scene. */
int ted4_sv_seed_applies(const ted4_trainer *t);

/* Adds at most most anchors, spread evenly over all that is missing. Returns 0, or -1 with
 * t->message filled. */
int ted4_sv_seed(ted4_trainer *t, size_t most);

#endif
