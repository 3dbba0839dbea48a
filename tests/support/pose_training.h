/* pose_training.h - a training of the scene of balls in which poses are refined on trial.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_POSE_TRAINING_H
#define TED4_POSE_TRAINING_H

#include "ball_trainer.h"

/* Steps of stage 1. Poses move freely until FREE; the trial of refinement ends at DECIDED. */
enum { STAGE1 = 2000, FREE = STAGE1 / 5, DECIDED = 3 * STAGE1 / 10 };

static inline ted4_train_options pose_options(void)
{
    ted4_train_options o = ball_options();

    ball_set(&o, "stage1=2000");
    ball_set(&o, "probe=0");
    ball_set(&o, "dropout=0");
    return o;
}

#endif
