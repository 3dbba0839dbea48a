/* weight_grid.h - weight grids: rounds network weights to grids that are as coarse as trials allow
 * (model_search.h). The format stores binary32 values; on a coarse grid their lower bytes are
 * mostly 0, which deflate codes at almost no cost (spec 7.2).
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_WEIGHT_GRID_H
#define TED4_WEIGHT_GRID_H

#include <stddef.h>

#include "norm/prior.h"

/* One entry of bits[] per grid. Heads, motion networks and bank: number of bits below the largest
 * weight of a unit, or of the bank, not counting the sign. Prior: the finest shift (7.3). */
typedef enum {
    TED4_WEIGHT_GRID_HEADS,
    TED4_WEIGHT_GRID_MOTION,
    TED4_WEIGHT_GRID_BANK,
    TED4_WEIGHT_GRID_PRIOR,
    TED4_WEIGHT_GRIDS
} ted4_weight_grid;

/* The finest setting, equal to binary32 or to the largest shift: nothing is changed. */
#define TED4_WEIGHT_GRID_FULL(grid) ((grid) == TED4_WEIGHT_GRID_PRIOR ? TED4_MAX_SHIFT : 24)

/* Sets bits [TED4_WEIGHT_GRIDS] to full precision. */
void ted4_weight_grid_full(int *bits);
/* Rounds x to multiples of 2^(e - bits), where 2^e is the smallest power of two that no |x|
 * exceeds; ties to even. Rounding is idempotent. */
void ted4_weight_grid_round(float *x, size_t n, int bits);
/* Rounds the reconstruction networks, netr[n_netr], and the bank, bank[n_bank], of this shape. Each
 * unit, and the biases of each layer, have a grid of their own. bits: [TED4_WEIGHT_GRIDS]. */
void ted4_weight_grid_scene(const ted4_shape *s, const int *bits, float *netr, float *bank);

#endif
