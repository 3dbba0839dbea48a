/* depth_map.h - dense depth of a training picture: plane sweeping over other pictures, and
 * semi-global matching, which carries depths from texture into its plain surroundings. The pictures
 * are reduced first, by area averaging. Source: H. Hirschmueller, "Stereo Processing by Semiglobal
 * Matching and Mutual Information", IEEE PAMI 30(2), 2008. Depends on sweep.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_DEPTH_MAP_H
#define TED4_DEPTH_MAP_H

#include "data/sweep.h"

/* CELLS: most pixels of a reduced picture. PLANES: tested depths of each. */
enum { TED4_DEPTH_CELLS = 1 << 13, TED4_DEPTH_PLANES = 128 };

/* A reduced picture. Its cells are squares of pixels of the full picture. */
typedef struct {
    ted4_camera camera; /* of the reduced picture, in cells */
    /* cell: owned, [height][width][4]: red, green, blue, and the deviation of the brightness from
     * its surroundings, plus 128 */
    uint8_t *cell;
} ted4_reduced;

/* Reduces picture i of *s. Returns 0, or -1 if memory ran out; free *r in either case. */
int ted4_reduce(ted4_reduced *r, const ted4_shown *s, size_t i);
void ted4_reduced_free(ted4_reduced *r);

/* Finds the inverse depth of each cell of r among the planes between the depths of w, which are
 * uniform in inverse depth. helper: [n_helpers] other pictures; at least two must see a cell.
 * inverse: [height][width], 1 / world units, 0 where nothing is known. Returns 0, or -1 if memory
 * ran out. */
int ted4_depth_map(const ted4_sweep *w, const ted4_reduced *r, const ted4_reduced *const *helper,
                   int n_helpers, float *inverse);

/* The distance of consecutive planes in inverse depth. */
double ted4_depth_step(const ted4_sweep *w);

#endif
