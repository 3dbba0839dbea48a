/* normalise.h - normalised space (spec 6.1, 11): world = origin + 2^exponent p; transforms cameras
 * and points into it.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_NORMALISE_H
#define TED4_NORMALISE_H

#include "data/dataset.h"
#include "norm/syntax.h"
#include "render/raster.h"

/* Chooses the normalised space and fills its members of *h. The origin is the component-wise median
 * of the initial points (FP16 is finest there). The exponent is the smallest that puts 99.5 % of
 * the points inside [-1, 1], with a margin of a quarter. */
void ted4_normalise_scene(ted4_header *h, const ted4_dataset *d);

/* Near plane: the smallest distance at which Gaussians are rendered, in normalised space. */
#define TED4_NEAR 0.02f

/* Computes the view of a camera in normalised space, and the camera centre. */
void ted4_normalise_view(const ted4_header *h, const ted4_camera *c, ted4_view *v, float centre[3]);
/* Transforms a point from world space to normalised space. */
void ted4_normalise_point(const ted4_header *h, const float world[3], float p[3]);

#endif
