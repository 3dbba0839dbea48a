/* branch.c - trains a number of steps on trial: see branch.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "branch.h"

#include "train/monitor/monitor.h"
#include "train/step/step.h"

int ted4_branch_run(ted4_trainer *t, int n, double *loss)
{
    const uint64_t begin = t->iteration;
    int bad = 0;

    ted4_monitor_forget(t);
    t->monitor.pinned = 1;
    *loss = 0;
    while (!bad && t->iteration < begin + (uint64_t)n) {
        const uint64_t i = t->iteration - begin, rollbacks = t->monitor.state.rollbacks;

        bad = ted4_gradient_step(t) != 0;
        if (t->monitor.state.rollbacks > rollbacks)
            *loss = 0;
        else if (i >= (uint64_t)n / 2)
            *loss += t->progress.last_loss / (n - n / 2);
    }
    t->monitor.pinned = 0;
    ted4_monitor_forget(t);
    return bad;
}
