/* loss_terms.h - what is added to the gradients of a picture: volume, smoothness of the bank, rate.
 * Source: paper, "Training Objectives". Depends on trainer.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_LOSS_TERMS_H
#define TED4_LOSS_TERMS_H

#include "train/state/trainer.h"

/* Volume: weight times the mean of the product of scales over the Gaussians on screen, into
 * t->work.splat_gradient. Returns how many there are, and tells the monitor, with the norm of the
 * gradients of their centres: not finite where one is not. */
size_t ted4_update_volume(ted4_trainer *t, const ted4_splats *s);
/* Bank: mean squared second difference of its rows, into t->net.gradient. */
void ted4_update_bank(ted4_trainer *t);
/* Rate of a random share of the visible blocks: gradients of bits on values, masks and NETE, and of
 * the distortion on step sizes. Puts visible blocks in another order. 0, or -1 with t->message. */
int ted4_update_rate(ted4_trainer *t, uint64_t key);

#endif
