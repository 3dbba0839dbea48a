/* file_cost.h - the cost of a model, by making its file and drawing pictures from it. Depends on
 * trainer.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_FILE_COST_H
#define TED4_FILE_COST_H

#include "train/state/trainer.h"

/* Of the model as it is: ends stage 2 on a copy, codes it, and draws some training pictures from
 * it. 0, or -1 with t->message. */
int ted4_file_cost(ted4_trainer *t, ted4_cost *c);
/* What a bit of the file weighs. */
double ted4_lambda_per_bit(const ted4_trainer *t);

/* In training steps: what one such cost takes; what trials may take altogether. */
double ted4_file_cost_steps(const ted4_trainer *t);
double ted4_search_budget(const ted4_trainer *t);
/* The same number of steps, or 0: too large a part of that budget for one decision. */
double ted4_search_afford(const ted4_trainer *t, double steps);

/* Appends to t->search.trial. 0, or -1 with t->message. */
int ted4_search_note(ted4_trainer *t, const struct ted4_trial *x);

#endif
