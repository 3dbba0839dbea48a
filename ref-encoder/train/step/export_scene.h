/* export_scene.h - converts a trained model to a scene of the file format (spec 6 to 10). Depends
 * on trainer.h, norm/.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_EXPORT_SCENE_H
#define TED4_EXPORT_SCENE_H

#include "train/state/trainer.h"

/* Makes the scene. Anchors without a kept offset are left out (dead anchors were removed when stage
 * 2 began). Symbols are rounded with the steps that the decoder will derive. If training stopped
 * before the end of stage 2, completes stage 2 first. *scene is owned by the caller
 * (ted4_scene_free). Returns 0, or -1 with t->message filled and t->is_empty set. */
int ted4_export_scene(ted4_trainer *t, ted4_scene **scene);

#endif
