/* viewpoints.h - whether the training pictures are taken from enough places to tell depths. Depends
 * on trainer.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_VIEWPOINTS_H
#define TED4_VIEWPOINTS_H

#include "train/state/trainer.h"

/* Returns whether the training pictures are taken from at least TED4_CAMERAS_NEEDED distinct places
 * (photo_votes.h), whatever their times: with fewer, chance matches decide on depths. Poses are
 * those of the scene, which never change. Needs t->layout. */
int ted4_has_viewpoints(const ted4_trainer *t);

#endif
