/* raster_plain.h - the image model of raster.h as plainly as it can be said: double precision, no
 * tiles, every Gaussian at every pixel. The twin against which raster.h and its adjoint are tested;
 * much too slow for anything else.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_RASTER_PLAIN_H
#define TED4_RASTER_PLAIN_H

#include "render/raster.h"

/* image: planar [3][height][width]. 0, or -1: no memory. */
int ted4_raster_plain(const ted4_splats *s, const ted4_view *v, double *image);

#endif
