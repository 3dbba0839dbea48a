/* block_exchange.h - the backward pass of the generator by several processes, of which each has
 * some of the visible blocks: those of some of the generator's chunks, which are neighbours. Sums
 * over blocks are taken chunk by chunk as by one process, so the bits are the same. Depends on
 * trainer.h, exchange.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_BLOCK_EXCHANGE_H
#define TED4_BLOCK_EXCHANGE_H

#include "trainer.h"

/* Returns whether there are several processes. If not, the functions below are not to be called. */
int ted4_blocks_shared(const ted4_trainer *t);
/* Divides an array of so many floats for each of the rendered blocks (t->visible_blocks.awake):
 * rank r has floats first[r] to first[r + 1]. first: [TED4_MAX_RANKS + 1]. */
void ted4_block_parts(const ted4_trainer *t, size_t floats, size_t *first);
/* Does what ted4_generate_backward does. Of gr, reads what belongs to this rank's blocks. All ranks
 * receive t->visible_blocks.gradient of all rendered blocks, and t->net.gradient. Returns 0, or -1
 * with t->message filled. */
int ted4_block_backward(ted4_trainer *t, const ted4_generate_input *in, const ted4_splat_grads *gr);
/* Gives all ranks the gradients of the centres of Gaussians, of which each has those of its
 * blocks. */
void ted4_block_share_centres(const ted4_trainer *t);

#endif
