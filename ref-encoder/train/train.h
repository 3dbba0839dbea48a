/* train.h - training of one scene, step by step. Depends on search/.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_TRAIN_H
#define TED4_TRAIN_H

#include "train/state/trainer.h"

/* Runs one training step, preceded by whatever is due before it (train.c). If the monitor finds
 * that training goes wrong, the call rolls back to the last good state instead (step/step.h). If
 * the static test finds that the scene needs no time, iteration is 1 afterwards; if the model
 * search has trained a model, iteration is many steps further. Returns 0, or -1 with t->message;
 * monitor.found then tells whether the cause is an anomaly that the monitor could not recover
 * from. */
int ted4_trainer_step(ted4_trainer *t);
/* Does the next step include a test or search that takes as long as many steps? */
int ted4_trainer_long_step(const ted4_trainer *t);

#endif
