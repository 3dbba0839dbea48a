/* camera_exposure_init.h - finds out before training whether the exposures of cameras change over
 * time, each on its own, and what they are, from what each camera sees at the initial points.
 * Source: ours. Depends on trainer.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_CAMERA_EXPOSURE_INIT_H
#define TED4_CAMERA_EXPOSURE_INIT_H

#include "train/state/trainer.h"

/* Initialises t->colour.exposure. Exposures are not corrected (n_knots 0) if t->opt.exposure is 0,
 * no camera is corrected, the initial points are random, a camera takes too few pictures, or the
 * gains differ by less than a hundredth from camera to camera (the root mean square over cameras
 * and knots, which t->colour.exposure_change receives). Only training pictures count. Returns 0, or
 * -1 with t->message filled. */
int ted4_camera_exposure_init(ted4_trainer *t);

#endif
