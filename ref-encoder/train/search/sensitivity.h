/* sensitivity.h - what each Gaussian is worth to the pictures. Depends on trainer.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_SENSITIVITY_H
#define TED4_SENSITIVITY_H

#include "train/state/trainer.h"

#define TED4_UNSEEN (-1.0f)
/* What each Gaussian does to training pictures, all of them if there is time: mean over them of
 * |dL / d(log opacity)|: use[n][K]; TED4_UNSEEN where none that was looked at shows it, but others
 * may. At rest the signed sum is near zero, and says nothing. 0, or -1 with t->message. */
int ted4_opacity_sensitivity(ted4_trainer *t, float *use);
/* What that takes, in training steps. */
double ted4_opacity_sensitivity_steps(const ted4_trainer *t);

#endif
