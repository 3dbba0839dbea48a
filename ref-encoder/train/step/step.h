/* step.h - one training step: forward and backward pass of the pictures of a batch, all of one
 * time, and the update. Depends on trainer.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_STEP_H
#define TED4_STEP_H

#include "train/state/trainer.h"

/* Does one step, after the events that are due before it (events.h). If the monitor finds an
 * anomaly, rolls back to the last good state instead: then t->iteration is smaller or the same,
 * t->monitor.state.rollbacks is larger, and t->monitor.anomaly and t->message describe the cause.
 * Returns 0, or -1 with t->message filled; then t->monitor.found tells whether the cause is an
 * anomaly that was not handled. */
int ted4_gradient_step(ted4_trainer *t);

#endif
