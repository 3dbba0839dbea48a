/* visible_blocks.h - which blocks a view sees, and the buffers of a step, filled for them. Depends
 * on trainer.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_VISIBLE_BLOCKS_H
#define TED4_VISIBLE_BLOCKS_H

#include "trainer.h"

/* Bit j: anchor j of the block can be seen. */
uint32_t ted4_block_visible(const ted4_trainer *t, size_t block, const ted4_view *v);

/* t->visible blocks become the blocks that v sees, in order; NULL: all blocks. 0, or -1 with
 * t->message. */
int ted4_visible_blocks_fill(ted4_trainer *t, const ted4_view *v);
/* In stage 2: fills visible blocks.used, from values and steps as they are now. In stage 1 that is
 * raw. */
void ted4_visible_blocks_quantise(ted4_trainer *t, ted4_quant quant);
/* Frees the buffers. */
void ted4_visible_blocks_finish(ted4_visible_blocks *s);

#endif
