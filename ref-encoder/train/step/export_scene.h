/* export_scene.h - from a trained model to a scene of the file format (spec 6 to 10).
 * Depends on trainer.h, norm/.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_MAKE_SCENE_H
#define TED4_MAKE_SCENE_H

#include "train/state/trainer.h"

/* Anchors without a kept offset are left out (those that no time shows went when stage 2 began);
 * symbols are rounded with the steps that the decoder will derive. Ends stage 2 first if training
 * stopped before it. *scene belongs to the caller (ted4_scene_free). 0, or -1 with t->message. */
int ted4_make_scene(ted4_trainer *t, ted4_scene **scene);

/* Which Gaussians of anchor i the file would have: bit k that of offset k; 0: the anchor is left
 * out. */
uint16_t ted4_offset_bits(const ted4_trainer *t, size_t i);
/* Would the file say that anchor i moves? */
int ted4_is_dynamic(const ted4_trainer *t, size_t i);
/* Of how many? */
size_t ted4_count_dynamic(const ted4_trainer *t);

#endif
