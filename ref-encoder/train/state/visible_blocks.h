/* visible_blocks.h - which blocks a view sees, and the buffers of a step for these blocks. Depends
 * on trainer.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_VISIBLE_BLOCKS_H
#define TED4_VISIBLE_BLOCKS_H

#include "trainer.h"

/* Bit j of the result: anchor j of the block is visible. */
uint32_t ted4_block_visible(const ted4_trainer *t, size_t block, const ted4_view *v);

/* Sets t->visible_blocks to the blocks that v sees, in order of their numbers; v NULL: to all
 * blocks. Returns 0, or -1 with t->message. */
int ted4_visible_blocks_fill(ted4_trainer *t, const ted4_view *v);
/* Does the same for n views: the blocks and lanes that at least one of them sees; n 0: all. */
int ted4_visible_blocks_of(ted4_trainer *t, const ted4_view *v, size_t n);
/* In stage 2, fills t->visible_blocks.used from the current values and step sizes. In stage 1, used
 * is the same as raw. */
void ted4_visible_blocks_quantise(ted4_trainer *t, ted4_quant quant);
/* Returns the input of rate/rate.h for all of t->visible_blocks in the integer stage, without
 * gradients. It is valid until t->visible_blocks is filled again. */
ted4_rate_input ted4_visible_blocks_rate(const ted4_trainer *t);
/* Reorders t->visible_blocks so that the blocks come first, in order of their numbers, that hold an
 * anchor whose activation at the time of *in, with the values used, lets it be drawn; their number
 * is t->visible_blocks.awake, and all of them without activation. Call after
 * ted4_visible_blocks_quantise, before gradients are written. */
void ted4_visible_blocks_wake(ted4_trainer *t, const ted4_generate_input *in);
/* Frees the buffers. */
void ted4_visible_blocks_finish(ted4_visible_blocks *s);

#endif
