/* model_search.h - how much model a scene needs: trials early in stage 2, each a smaller model
 * against the one at hand, by the cost of the file. Depends on trainer.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_MODEL_SEARCH_H
#define TED4_MODEL_SEARCH_H

#include "train/state/trainer.h"

/* The step at which the search is due; UINT64_MAX: never. */
uint64_t ted4_model_search_due_step(const ted4_trainer *t);
/* Training steps that the search may take: what the end of stage 2 leaves it. */
double ted4_model_search_steps(const ted4_trainer *t);
/* Settles what the model is; t is at the step of ted4_model_search_due_step. Afterwards it is as
 * many steps further as a trial has, if any was trained. 0, or -1 with t->message. */
int ted4_model_search(ted4_trainer *t);

#endif
