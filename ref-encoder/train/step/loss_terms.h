/* loss_terms.h - the terms of the loss besides the picture: volume, smoothness of the bank, rate.
 * Source: paper, "Training Objectives". Depends on trainer.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_LOSS_TERMS_H
#define TED4_LOSS_TERMS_H

#include "train/state/trainer.h"

/* Volume: adds the gradient of weight times the mean product of scales, over the Gaussians on
 * screen, to t->work.splat_gradient. Returns the number of these Gaussians. Reports it to the
 * monitor, with the norm of the gradients of their centres, which is not finite if one of these is
 * not. */
size_t ted4_update_volume(ted4_trainer *t, const ted4_splats *s);
/* Bank: adds the gradient of the mean squared second difference of its rows to t->net.gradient. */
void ted4_update_bank(ted4_trainer *t);
/* Rate, of a random share of the visible blocks: adds the gradients of bits on values, masks and
 * NETE, and of the distortion on step sizes. Reorders the visible blocks. Returns 0, or -1 with
 * t->message filled. */
int ted4_update_rate(ted4_trainer *t, uint64_t key);

#endif
