/* prior_bits.h - bits of the prior's weights that are given back. Depends on trainer.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_PRIOR_BITS_H
#define TED4_PRIOR_BITS_H

#include "train/state/trainer.h"

/* Training steps that ted4_refine_prior_bits takes at most; 0: the budget is too small for it. */
double ted4_refine_prior_bits_steps(const ted4_trainer *t);
/* When the integer stage is about to begin, which is when weights become as coarse as they will be
 * in the file: bits of the prior's that it has come to need since trials coarsened them are given
 * back. 0, or -1 with t->message. */
int ted4_refine_prior_bits(ted4_trainer *t);

#endif
