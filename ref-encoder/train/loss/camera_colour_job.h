/* camera_colour_job.h - the job of correcting a picture's colours in bands of pixels. Private to
 * camera_colour.c and camera_colour_bands.c.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_CAMERA_COLOUR_JOB_H
#define TED4_CAMERA_COLOUR_JOB_H

#include "camera_colour.h"
#include "render/leveled.h"

/* Number of pixels whose products are summed in single precision, and of pixels of one job. */
enum { TED4_COLOUR_RUN = 1024, TED4_COLOUR_BAND = 16 * TED4_COLOUR_RUN };

typedef struct {
    const float *image, *map;
    float *to; /* apply: the corrected picture; backward: the gradient, in place */
    double *sums;
    size_t pixels;
} ted4_colour_job;

TED4_EACH_LEVEL(void, ted4_colour_apply_band, void *job, size_t band);
/* Writes the sums of the band, then transforms the gradient by the map. */
TED4_EACH_LEVEL(void, ted4_colour_backward_band, void *job, size_t band);

#endif
