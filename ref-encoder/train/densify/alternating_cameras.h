/* alternating_cameras.h - alternating cameras: where no time has enough pictures to tell where
 * something is, those of the times around it are looked at with it. Depends on trainer.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_ALTERNATING_CAMERAS_H
#define TED4_ALTERNATING_CAMERAS_H

#include "train/state/trainer.h"

/* With fewer cameras at a time chance matches decide. */
enum { TED4_CAMERAS_NEEDED = 3 };

/* Frames before and after a frame whose pictures are looked at together with its own: 0 where
 * some time has so many cameras itself; else as few as give most frames that have a picture one
 * camera more than that, each in a place of its own; -1 where no small number does (one camera
 * that hardly moves, two that stand still). */
int ted4_alternating_reach(const ted4_trainer *t);

/* Do two cameras look from places so far apart that the depth of what both see can be told?
 * Their centres are in normalised space. */
int ted4_cameras_apart(const float a[3], const float b[3]);

#endif
