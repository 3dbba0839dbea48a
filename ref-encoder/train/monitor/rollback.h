/* rollback.h - keeps the last good state, and restores it after an anomaly. Depends on trainer.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_ROLLBACK_H
#define TED4_ROLLBACK_H

#include "train/state/trainer.h"

/* Call before each step. Checks the learnt parameters, including all anchors from time to time,
 * and then keeps the state. Returns 0, or -1 with t->message filled, and with monitor.found set if
 * it is an anomaly. */
int ted4_monitor_begin(ted4_trainer *t);
/* Call after a step that failed. Restores the last good state, with smaller learning rates, if the
 * failure is an anomaly, if there is such a state, and if this was not done TED4_ROLLBACKS times
 * (monitor.h) already. Returns 0, or -1 with t->message filled. */
int ted4_monitor_recover(ted4_trainer *t);

#endif
