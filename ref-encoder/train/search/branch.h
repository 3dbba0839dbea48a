/* branch.h - trains for a number of steps on trial, to compare losses. Depends on trainer.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_BRANCH_H
#define TED4_BRANCH_H

#include "train/state/trainer.h"

/* Trains n steps from the current state, which is also the one that a rollback restores. *loss
 * receives the mean loss of the second half. Returns 0, or -1 with t->message filled. */
int ted4_branch_run(ted4_trainer *t, int n, double *loss);

#endif
