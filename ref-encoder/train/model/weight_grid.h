/* weight_grid.h - weights of a file on grids that are as coarse as trials find them good enough
 * (model_search.h). The format keeps binary32; of what is coarse the lower bytes are mostly 0, and
 * deflate leaves them out (spec 7.2).
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_WEIGHT_GRID_H
#define TED4_WEIGHT_GRID_H

#include <stddef.h>

#include "norm/prior.h"

/* Heads, networks of motion and bank: bits below the largest weight of a unit, or of the bank,
 * without its sign. Prior: the finest shift (7.3). */
typedef enum {
    TED4_WEIGHT_GRID_HEADS,
    TED4_WEIGHT_GRID_MOTION,
    TED4_WEIGHT_GRID_BANK,
    TED4_WEIGHT_GRID_PRIOR,
    TED4_WEIGHT_GRIDS
} ted4_weight_grid;

/* As fine as binary32, and as any shift, is: nothing is changed. */
#define TED4_WEIGHT_GRID_FULL(grid) ((grid) == TED4_WEIGHT_GRID_PRIOR ? TED4_MAX_SHIFT : 24)

/* All bits of everything: bits [TED4_WEIGHT_GRIDS]. */
void ted4_weight_grid_full(int *bits);
/* To multiples of 2^(e - bits), 2^e the smallest power of two that no |x| is above; halves to even.
 * What was rounded stays where it is if it is rounded again. */
void ted4_weight_grid_round(float *x, size_t n, int bits);
/* The networks of reconstruction, netr[n_netr], and the bank, bank[n_bank], of this shape: each
 * unit, and the biases of each layer, on a grid of their own. bits: [TED4_WEIGHT_GRIDS]. */
void ted4_weight_grid_scene(const ted4_shape *s, const int *bits, float *netr, float *bank);

#endif
