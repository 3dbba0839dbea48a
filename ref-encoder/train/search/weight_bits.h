/* weight_bits.h - how many bits the weights of networks and the bank need in the file, where the
 * capacity is fixed: it says how large the model is, not how finely its file writes it.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_WEIGHT_BITS_H
#define TED4_WEIGHT_BITS_H

#include "train/state/trainer.h"

/* Upper bound of what ted4_coarsen_weights takes, in training steps. 0: nothing is to be found out,
 * because the model search did it, in profile Main, or because the budget is too small. */
double ted4_coarsen_weights_steps(const ted4_trainer *t);
/* Makes each weight grid coarser while that lowers the cost of the file (file_cost.h). Call it
 * once, just before the integer stage. Returns 0, or -1 with t->message. */
int ted4_coarsen_weights(ted4_trainer *t);

#endif
