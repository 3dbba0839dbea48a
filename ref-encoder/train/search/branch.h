/* branch.h - steps that are taken to find something out. Depends on trainer.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_BRANCH_H
#define TED4_BRANCH_H

#include "train/state/trainer.h"

/* n steps from where t stands, which a rollback goes back to; *loss: mean loss of the second half.
 * 0, or -1 with t->message. */
int ted4_branch_run(ted4_trainer *t, int n, double *loss);

#endif
