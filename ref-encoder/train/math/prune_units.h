/* prune_units.h - which units of a layer may go, and how the layers that read them make up for it
 * by what stays. Optimal brain surgeon on linear readers: a unit that goes is replaced by its
 * least-squares estimate from those that stay and a constant.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_PRUNE_UNITS_H
#define TED4_PRUNE_UNITS_H

#include <stddef.h>
#include <stdint.h>

/* from units become the units keep[0 .. to), rising; unit i is about sum over k of decode[i][k]
 * x[keep[k]], plus decode[i][to]. */
typedef struct {
    int from, to;
    int *keep;      /* owned, [to] */
    double *decode; /* owned, [from][to + 1] */
} ted4_pruned_units;

/* What is known about n units: moment[n + 1][n + 1], means of products of units, with a constant 1
 * as the last one; readers[n_rows][n], the weights of all that read them. held: [n], 1 where a unit
 * must stay; NULL: none must. */
typedef struct {
    int n, n_rows;
    const double *moment;
    const float *readers;
    const uint8_t *held;
} ted4_units;

/* Takes away, one by one, the unit that readers miss least, until to of them are left. 0, or -1: no
 * memory. The caller's afterwards, for ted4_pruned_units_finish. */
int ted4_prune_units(ted4_pruned_units *w, const ted4_units *u, int to);
void ted4_pruned_units_finish(ted4_pruned_units *w);

#endif
