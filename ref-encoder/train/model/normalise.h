/* normalise.h - normalised space (spec 6.1, 11): world = origin + 2^exponent p, and cameras seen
 * from there.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_NORMALISE_H
#define TED4_NORMALISE_H

#include "data/dataset.h"
#include "norm/syntax.h"
#include "render/raster.h"

/* Origin: component-wise median of the initial points (FP16 is finest there). Exponent: the
 * smallest that puts 99.5 % of the points, with a margin of a quarter, inside [-1, 1]. Fills those
 * members of *h. */
void ted4_normalise_scene(ted4_header *h, const ted4_dataset *d);

/* Nearest distance at which Gaussians are drawn, in normalised space. */
#define TED4_NEAR 0.02f

/* The view of a picture in normalised space, and its camera centre. */
void ted4_normalise_view(const ted4_header *h, const ted4_camera *c, ted4_view *v, float centre[3]);
/* World to normalised. */
void ted4_normalise_point(const ted4_header *h, const float world[3], float p[3]);

#endif
