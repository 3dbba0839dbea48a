/* step.h - one training step: a picture, its Gaussians forward and back, and the update. Depends on
 * trainer.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_STEP_H
#define TED4_STEP_H

#include "train/state/trainer.h"

/* One step, after what is due before it (events.h). Or, where the monitor finds that training goes
 * wrong, the way back to the last good state: iteration is then smaller or the same,
 * monitor.state.rollbacks larger, and monitor.anomaly and message say why. 0, or -1 with
 * t->message; monitor.found then tells whether it is an anomaly that nothing more was done about.
 */
int ted4_gradient_step(ted4_trainer *t);

#endif
