/* model_search.h - finds the size of the model that a scene needs: trials early in stage 2 compare
 * smaller models with the current one by the cost of the file. Depends on trainer.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_MODEL_SEARCH_H
#define TED4_MODEL_SEARCH_H

#include "train/state/trainer.h"

/* Returns the step at which the search is due, or UINT64_MAX if there is no search. */
uint64_t ted4_model_search_due_step(const ted4_trainer *t);
/* Returns the budget of the search in training steps: that of all trials, less what is reserved for
 * the end of stage 2. */
double ted4_model_search_steps(const ted4_trainer *t);
/* Decides the size of the model. t must be at the step of ted4_model_search_due_step. If trials
 * were trained, t is further by the steps of one trial afterwards. Returns 0, or -1 with t->message
 * filled. */
int ted4_model_search(ted4_trainer *t);

#endif
