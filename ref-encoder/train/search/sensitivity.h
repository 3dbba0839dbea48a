/* sensitivity.h - measures how much the pictures depend on each Gaussian. Depends on trainer.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_SENSITIVITY_H
#define TED4_SENSITIVITY_H

#include "train/state/trainer.h"

#define TED4_UNSEEN (-1.0f)
/* Computes the opacity sensitivity of each Gaussian: the mean of |dL / d(log opacity)| over
 * training pictures, all of them if there is time. use: [n][K], TED4_UNSEEN for a Gaussian that no
 * sampled picture shows but others may. (After convergence, the signed sum is near zero and tells
 * nothing.) Returns 0, or -1 with t->message filled. */
int ted4_opacity_sensitivity(ted4_trainer *t, float *use);
/* Returns the time that ted4_opacity_sensitivity takes, in training steps. */
double ted4_opacity_sensitivity_steps(const ted4_trainer *t);

#endif
