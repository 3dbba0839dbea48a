/* octree.h - spec 8.2: codes positions as an octree, whose occupancy bits have adaptive
 * probabilities. Positions come in the order of their keys, so that no order is stored.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_OCTREE_H
#define TED4_OCTREE_H

#include "norm/coder.h"

enum { TED4_OCTREE_DEPTH = 16 };

/* Codes n > 0 different positions, position[n][3], as patterns of coordinates on a grid of depth
 * bits (1 .. 12, or 16: half.h). Their keys increase; a key is the Morton code of the places, with
 * three bits per level, the highest first. The substream is open already; its number of symbols is
 * not known beforehand. A reading coder fills position; with depth 16, coordinates may be illegal.
 * Returns 1 if the tree has n leaves, otherwise 0: then position holds what was read, and it may be
 * that not all was read. At most 8 depth (n + 1) symbols are coded. */
int ted4_octree_walk(ted4_coder *c, unsigned depth, size_t n, uint16_t *position);
/* Returns the key of position p[3], which lies on the grid. */
uint64_t ted4_octree_key(const uint16_t *p, unsigned depth);

#endif
