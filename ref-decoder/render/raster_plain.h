/* raster_plain.h - a reference implementation of the image model of raster.h: double precision, no
 * tiles, every Gaussian at every pixel. raster.h and its adjoint are tested against it; it is much
 * too slow for anything else.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_RASTER_PLAIN_H
#define TED4_RASTER_PLAIN_H

#include "render/raster.h"

/* Renders into image, planar [3][height][width]. Returns 0, or -1 if out of memory. */
int ted4_raster_plain(const ted4_splats *s, const ted4_view *v, double *image);

#endif
