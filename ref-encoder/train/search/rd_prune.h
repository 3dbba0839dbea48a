/* rd_prune.h - anchors and Gaussians go that are not worth their bits. Depends on trainer.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_RD_PRUNE_H
#define TED4_RD_PRUNE_H

#include "train/state/trainer.h"

/* Training steps that ted4_rd_prune takes at most; 0: the budget is too small for it, or
 * there is no mask. */
double ted4_rd_prune_steps(const ted4_trainer *t);
/* Once the integer stage has begun: anchors and Gaussians go whose bits weigh more than what
 * pictures would miss of them. 0, or -1 with t->message. */
int ted4_rd_prune(ted4_trainer *t);

#endif
