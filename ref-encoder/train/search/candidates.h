/* candidates.h - the ways to make the model smaller. Depends on trainer.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_CANDIDATES_H
#define TED4_CANDIDATES_H

#include "train/state/trainer.h"

/* Returns the name of a candidate, e.g. "width of the hyperprior". */
const char *ted4_candidate_name(ted4_candidate m);

/* ted4_candidate_now returns the current size of what a candidate reduces (such as a width or a
 * number of bits); ted4_candidate_next returns the next smaller size to try, or a much smaller one
 * if bold is not 0, or -1 if there is none. */
int ted4_candidate_now(const ted4_trainer *t, ted4_candidate m);
int ted4_candidate_next(const ted4_trainer *t, ted4_candidate m, int bold);
/* The inverse, for candidates that reduce bits of weights: returns the next larger number of bits,
 * or -1 if there is none or the candidate is not one of these. */
int ted4_candidate_finer(const ted4_trainer *t, ted4_candidate m);
/* Changes the model so that the candidate's size becomes to. Returns 0, or -1 with t->message
 * filled. */
int ted4_candidate_make(ted4_trainer *t, ted4_candidate m, int to);

#endif
