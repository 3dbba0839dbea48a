/* colour_fit.h - fits a colour map (camera_colour.h) to pairs of colours by weighted least squares.
 * Source: normal equations and their Cholesky decomposition. Depends on camera_colour.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_COLOUR_FIT_H
#define TED4_COLOUR_FIT_H

#include "camera_colour.h"

/* The normal equations: sums over pairs of a colour (r, g, b) of the scene and the colour to that
 * a camera makes of it, 0 .. 1 each. */
typedef struct {
    double left[4][4];  /* of w x x^T with x = (r, g, b, 1); only i >= j is read */
    double right[4][3]; /* of w x (to - (r, g, b))^T */
    double weight;      /* of w */
} ted4_colour_sums;

/* Regularisation towards the identity, as a share of the weights: the square of noise of a few
 * levels of 255. With it, a map can be fitted to any colours, even to a single one. */
#define TED4_COLOUR_RIDGE 1e-4

/* Sets map to the solution. Overwrites the sums, whose weight must be above 0. */
void ted4_colour_solve(ted4_colour_sums *s, ted4_colour_map map);

#endif
