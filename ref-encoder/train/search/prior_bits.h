/* prior_bits.h - refinement: gives back bits of the prior's weights. Depends on trainer.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_PRIOR_BITS_H
#define TED4_PRIOR_BITS_H

#include "train/state/trainer.h"

/* Returns the training steps that ted4_refine_prior_bits takes at most, or 0 if the budget is too
 * small for it. */
double ted4_refine_prior_bits_steps(const ted4_trainer *t);
/* Gives back bits of the prior's weights that the prior has come to need since the model search
 * made them coarser. To be called just before the integer stage begins, from which on weights are
 * as coarse as in the file. Returns 0, or -1 with t->message filled. */
int ted4_refine_prior_bits(ted4_trainer *t);

#endif
