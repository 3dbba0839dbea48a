/* octree.h - codes a set of cells of a cubic grid as an octree, whose occupancy bits have adaptive
 * probabilities. Cells come in the order of their keys, so that no order is stored.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_OCTREE_H
#define TED4_OCTREE_H

#include "norm/coder.h"

enum { TED4_OCTREE_DEPTH = 16 };

/* Codes n > 0 different keys of 3 depth bits (1 .. TED4_OCTREE_DEPTH) in increasing order; a key is
 * a Morton code with three bits per level, the highest first. The substream is open already; its
 * number of symbols is not known beforehand. A reading coder fills key[n]. Returns 1 if the tree
 * has n leaves, otherwise 0: then key holds what was read, and it may be that not all was read. At
 * most 8 depth (n + 1) symbols are coded. */
int ted4_octree_walk(ted4_coder *c, unsigned depth, size_t n, uint64_t *key);

#endif
