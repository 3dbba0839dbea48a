/* alternating_cameras.h - support for alternating cameras: where no frame has enough pictures to
 * locate objects in space, the pictures of neighbouring frames are used with it. Depends on
 * trainer.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_ALTERNATING_CAMERAS_H
#define TED4_ALTERNATING_CAMERAS_H

#include "train/state/trainer.h"

/* Least number of cameras per frame. With fewer cameras, chance matches decide. */
enum { TED4_CAMERAS_NEEDED = 3 };

/* Returns the reach: how many frames before and after a frame lend their pictures to it. It is 0 if
 * at least one frame has TED4_CAMERAS_NEEDED pictures itself. Otherwise it is the smallest number
 * with which most frames that have a picture get one camera more than that, each at a different
 * place. Returns -1 if no small number suffices (for example, one camera that hardly moves, or two
 * that stand still). */
int ted4_alternating_reach(const ted4_trainer *t);

/* Returns whether two cameras are far enough apart to triangulate the depth of what both see. a and
 * b are their centres in normalised space. */
int ted4_cameras_apart(const float a[3], const float b[3]);

#endif
