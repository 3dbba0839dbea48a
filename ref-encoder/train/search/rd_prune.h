/* rd_prune.h - removes anchors and Gaussians that are not worth their bits. Depends on trainer.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_RD_PRUNE_H
#define TED4_RD_PRUNE_H

#include "train/state/trainer.h"

/* Returns the training steps that ted4_rd_prune takes at most, or 0 if the budget is too small for
 * it or there is no offset mask. */
double ted4_rd_prune_steps(const ted4_trainer *t);
/* Removes anchors and Gaussians that cost more in rate than they gain in quality. To be called once
 * the integer stage has begun. Returns 0, or -1 with t->message filled. */
int ted4_rd_prune(ted4_trainer *t);

#endif
