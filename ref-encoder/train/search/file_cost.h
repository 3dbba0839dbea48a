/* file_cost.h - the rate-distortion cost of a model, measured by coding its file and rendering from
 * it. Depends on trainer.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_FILE_COST_H
#define TED4_FILE_COST_H

#include "train/state/trainer.h"

/* Measures the cost of the current model: completes stage 2 on a copy, codes it, and renders some
 * training pictures from it. Returns 0, or -1 with t->message filled. */
int ted4_file_cost(ted4_trainer *t, ted4_cost *c);
/* Returns the weight of one bit of the file in the loss. */
double ted4_lambda_per_bit(const ted4_trainer *t);

/* Time in units of training steps: ted4_file_cost_steps is that of one ted4_file_cost, and
 * ted4_search_budget is the budget of all trials together. */
double ted4_file_cost_steps(const ted4_trainer *t);
double ted4_search_budget(const ted4_trainer *t);
/* Returns steps, or 0 if that is too large a part of the budget for one decision. */
double ted4_search_afford(const ted4_trainer *t, double steps);

/* Appends *x to t->search.trial. Returns 0, or -1 with t->message filled. */
int ted4_search_note(ted4_trainer *t, const struct ted4_trial *x);

#endif
