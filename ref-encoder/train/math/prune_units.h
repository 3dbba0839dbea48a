/* prune_units.h - pruned units: chooses which units of a layer to remove, and adapts the layers
 * that read them. Optimal brain surgeon on linear readers: each removed unit is replaced by its
 * least-squares estimate from the remaining units and a constant.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_PRUNE_UNITS_H
#define TED4_PRUNE_UNITS_H

#include <stddef.h>
#include <stdint.h>

/* The old units, from in number, become the units keep[0 .. to), in increasing order. Old unit i is
 * approximated by the sum over k of decode[i][k] x[keep[k]], plus decode[i][to]. */
typedef struct {
    int from, to;
    int *keep;      /* owned, [to] */
    double *decode; /* owned, [from][to + 1] */
} ted4_pruned_units;

/* Statistics of n units. moment[n + 1][n + 1]: means of products of units, the last unit being the
 * constant 1. readers[n_rows][n]: the weights of all layers that read the units. held[n]: 1 where a
 * unit must stay, or NULL if none must. */
typedef struct {
    int n, n_rows;
    const double *moment;
    const float *readers;
    const uint8_t *held;
} ted4_units;

/* Removes, one by one, the unit whose removal changes the readers' outputs least, until to units
 * are left. Returns 0, or -1 if memory ran out. Free *w with ted4_pruned_units_finish. */
int ted4_prune_units(ted4_pruned_units *w, const ted4_units *u, int to);
void ted4_pruned_units_finish(ted4_pruned_units *w);

#endif
