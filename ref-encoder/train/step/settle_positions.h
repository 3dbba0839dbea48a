/* settle_positions.h - moves anchors to positions that the file can hold (spec 8).
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_SETTLE_POSITIONS_H
#define TED4_SETTLE_POSITIONS_H

#include "train/state/trainer.h"

/* Returns the bits a coordinate of the grid on which positions lie (spec 8.2); 16 in profile Main:
 * any binary16 value. */
unsigned ted4_position_bits(const ted4_trainer *t);
/* Returns the bits of an anchor in the file besides its values: its position (spec 8), and whether
 * it moves. Those of a grid are a mean over scenes of some thousand anchors. */
double ted4_anchor_bits(const ted4_trainer *t);
/* Returns the order of anchor i, at a settled position, in the file. */
uint64_t ted4_position_key(const ted4_trainer *t, size_t i);

/* Moves all anchors to the grid, and sorts them. On a grid of less than 16 bits, the offsets of an
 * anchor change with it, so that its Gaussians stay where they are; of anchors that fall into one
 * cell, all but the first move to the nearest free cell beside it. An anchor for which none is
 * free, and on 16 bits each that coincides with another one, is dropped. Scalings must be in log2.
 * Returns 0, or -1 with t->message. */
int ted4_settle_positions(ted4_trainer *t);

#endif
