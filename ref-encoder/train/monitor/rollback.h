/* rollback.h - the last good state, and the way back to it. Depends on trainer.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_ROLLBACK_H
#define TED4_ROLLBACK_H

#include "train/state/trainer.h"

/* Before a step: looks at what is learnt, from time to time at all anchors, and then keeps the
 * state. 0, or -1 with t->message, and with monitor.found when it is an anomaly. */
int ted4_monitor_begin(ted4_trainer *t);
/* After a step that failed: back to the last good state with smaller learning rates, if it was an
 * anomaly, there is such a state and this was not done three times. 0, or -1 with t->message. */
int ted4_monitor_recover(ted4_trainer *t);

#endif
