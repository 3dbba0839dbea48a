/* candidates.h - the ways to a smaller model. Depends on trainer.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_CANDIDATES_H
#define TED4_CANDIDATES_H

#include "train/state/trainer.h"

/* What a candidate is called, e.g. "hidden width of the hyperprior". */
const char *ted4_candidate_name(ted4_candidate m);

/* How much of a candidate's matter there is now, and the next smaller amount to try, or with bold a
 * much smaller one; -1: there is none. */
int ted4_candidate_now(const ted4_trainer *t, ted4_candidate m);
int ted4_candidate_next(const ted4_trainer *t, ted4_candidate m, int bold);
/* The way back: the next larger number of bits of weights; -1: there is none, or the candidate has
 * no such way. */
int ted4_candidate_finer(const ted4_trainer *t, ted4_candidate m);
/* Makes it so. 0, or -1 with t->message. */
int ted4_candidate_make(ted4_trainer *t, ted4_candidate m, int to);

#endif
