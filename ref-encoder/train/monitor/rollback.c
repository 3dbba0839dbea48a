/* rollback.c - keeps the last good state, and restores it after an anomaly (rollback.h).
 * SPDX-License-Identifier: BSD-2-Clause */
#include "rollback.h"

#include "checkpoint.h"
#include "monitor.h"

/* Number of steps between checks of all anchors, including those that are in no picture. */
enum { LOOK_EVERY = 100 };

/* All learning rates are multiplied by this at each rollback. */
#define SMALLER 0.5

int ted4_monitor_begin(ted4_trainer *t)
{
    ted4_monitor *w = &t->monitor;
    const int keep = w->good.bytes == NULL || (ted4_monitor_due(t) && w->good_at != t->iteration);

    w->found = 0;
    if (ted4_monitor_values(t, keep || t->iteration % LOOK_EVERY == 0) != 0)
        return -1;
    if (!keep)
        return 0;
    w->good_at = t->iteration;
    return ted4_state_take(t, &w->good);
}

int ted4_monitor_recover(ted4_trainer *t)
{
    ted4_monitor *w = &t->monitor;
    const uint64_t rollbacks = w->state.rollbacks;
    const double factor = w->state.factor, seconds = t->seconds;
    const ted4_message m = t->message;

    if (!w->found)
        return -1;
    if (w->good.bytes == NULL)
        return ted4_trainer_fail(t, "%.512s; there is no good state before it", m.text);
    if (rollbacks == TED4_ROLLBACKS)
        return ted4_trainer_fail(t,
                                 "%.512s; learning rates were made smaller %d times; another "
                                 "--seed, or smaller ones from the start (--set lr_...), may help",
                                 m.text, TED4_ROLLBACKS);
    if (ted4_state_restore(t, &w->good) != 0)
        return -1;
    w->found = 0;
    w->state.factor = SMALLER * factor;
    w->state.rollbacks = rollbacks + 1;
    t->seconds = seconds;
    ted4_monitor_forget(t);
    return 0;
}
