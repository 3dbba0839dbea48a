/* camera_colour_init.h - initial colour maps of the cameras, fitted before training to what each
 * camera sees at the initial points. Colour maps are also learnt together with the scene
 * (camera_colour.h), but slowly: without a good start, the scene first learns the tints as its own
 * colours and makes colour depend on the viewing direction, and the search for short-lived content
 * compares colours that do not match. Source: a robust fit of the model of camera_colour.h, ours.
 * Depends on trainer.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_CAMERA_COLOUR_INIT_H
#define TED4_CAMERA_COLOUR_INIT_H

#include "train/state/trainer.h"

/* Sets t->colour.value and t->colour.matched, and also t->colour.middle where the colours of the
 * points agree with the pictures. Changes nothing if cameras hardly differ, if the initial points
 * are random, or if too few of them are seen by two cameras. Returns 0, or -1 with t->message
 * filled. */
int ted4_camera_colour_init(ted4_trainer *t);

#endif
