/* export_scene.h - from a trained model to a scene of the file format (spec 6 to 10).
 * Depends on trainer.h, norm/.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_EXPORT_SCENE_H
#define TED4_EXPORT_SCENE_H

#include "train/state/trainer.h"

/* Anchors without a kept offset are left out (those that no time shows went when stage 2 began);
 * symbols are rounded with the steps that the decoder will derive. Ends stage 2 first if training
 * stopped before it. *scene belongs to the caller (ted4_scene_free). 0, or -1 with t->message. */
int ted4_export_scene(ted4_trainer *t, ted4_scene **scene);

#endif
