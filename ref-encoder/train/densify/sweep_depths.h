/* sweep_depths.h - the inner loop of plane sweeping (plane_sweep.c): depths along the ray through a
 * pixel, each judged by the other pictures of the frame.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_SWEEP_DEPTHS_H
#define TED4_SWEEP_DEPTHS_H

#include <stddef.h>
#include <stdint.h>

#include "render/leveled.h"
#include "render/raster.h"

enum { TED4_DEPTHS = 16 }; /* judged at a time, one per lane */

/* One picture of the frame. */
typedef struct {
    ted4_view view;
    float centre[3];         /* of the camera, normalised space */
    float nearest, farthest; /* range of the tested depths, normalised space */
    uint32_t *pixel; /* owned: red, green, blue, error of each pixel, from the lowest byte on */
    int depths;      /* number of tested depths, at least 2 */
} ted4_sweep_view;

/* The ray through a pixel of picture self, and what is there. */
typedef struct {
    const ted4_sweep_view *views; /* borrowed: [n] */
    size_t n, self;
    float ray[2]; /* view_geometry.h */
    uint32_t pixel;
} ted4_sweep_ray;

/* What is known of TED4_DEPTHS consecutive depths. */
typedef struct {
    float z[TED4_DEPTHS], p[3][TED4_DEPTHS]; /* depth, and point in normalised space */
    int32_t seen[TED4_DEPTHS];  /* number of other pictures in which the point lies; 0 outside the
                                   scene's cube, and beyond the last depth */
    int32_t agree[TED4_DEPTHS]; /* number of those that confirm it */
    float score[TED4_DEPTHS];   /* sum of how well they do, each in (0, 1] */
} ted4_swept_depths;

/* Judges the depths from number first on. */
TED4_EACH_LEVEL(void, ted4_sweep_depths, const ted4_sweep_ray *r, int first, ted4_swept_depths *d);

#endif
