/* camera_colour_init.h - first colour maps of the cameras, from what each sees at the initial
 * points, before anything is trained. What a camera does to colours is learnt beside the scene
 * (camera_colour.h), but slowly: until then the scene takes tints for its own and begins to change
 * colour with the direction of view, and what looks for things that come and go compares unlike
 * colours. Source: a robust fit of the model of camera_colour.h, ours. Depends on trainer.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_CAMERA_COLOUR_INIT_H
#define TED4_CAMERA_COLOUR_INIT_H

#include "train/state/trainer.h"

/* Sets t->colour.value and t->colour.matched, and t->colour.middle where the points' own colours
 * agree with the pictures; all stay as they are where cameras hardly differ, initial points are
 * random, or too few of them are seen by two cameras. 0, or -1 with t->message. */
int ted4_camera_colour_init(ted4_trainer *t);

#endif
