/* train.h - the training of one scene, step by step. Depends on search/.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_TRAIN_H
#define TED4_TRAIN_H

#include "train/state/trainer.h"

/* One step of the recipe, with whatever is due before it. Or, where the monitor finds that training
 * goes wrong, the way back to the last good state (step/step.h). Where the static test finds that
 * the scene needs no time, iteration is 1 afterwards; where the model search has trained a model,
 * it is many steps further. 0, or -1 with t->message; monitor.found then tells whether it is an
 * anomaly that nothing more was done about. */
int ted4_trainer_step(ted4_trainer *t);
/* Will the next step take as long as many, to find something out? */
int ted4_trainer_long_step(const ted4_trainer *t);

#endif
