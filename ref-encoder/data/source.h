/* source.h - how the file of one picture becomes its pixels, and where a scene's cameras look.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_SOURCE_H
#define TED4_SOURCE_H

#include "data/dataset.h"
#include "data/image_cache.h"
#include "data/undistort.h"

typedef struct ted4_source {
    const char *path; /* borrowed from the picture */
    ted4_lens lens;   /* of the file's size */
    int downscale;
    uint8_t background;    /* grey level under transparent pixels */
    uint8_t premultiplied; /* as the option */
    size_t n_partial;      /* pixels that are transparent in part, of the last decoding */
    size_t n_above;        /* of these, with a colour above alpha, which premultiplied have not */
    int is_known;          /* decoded before: a file with another digest is refused */
    uint64_t digest;
    double level; /* mean of all its bytes; 0 until ted4_dataset_verify */
} ted4_source;

/* ted4_image_decoder of an array of sources, which it tells apart from files that replace them
 * later: RGB composited, undistorted, downscaled, in this order. */
uint8_t *ted4_source_decode(void *sources, size_t i, size_t *size, ted4_message *m);

/* Cube of the random points of a Blender scene: the synthetic objects are made to fit it. */
#define TED4_BLENDER_HALF_CUBE 1.3

#define TED4_VIEW_BOX_HALF_SIDE 0.6 /* of the median distance of the cameras */

/* Cube that the cameras of training pictures look at: centre is the point nearest to all optical
 * axes in the least-squares sense, half the side is 0.6 of the median distance of the cameras from
 * it. Where the axes have no common point before the cameras (one camera, parallel or diverging
 * axes) centre lies ahead of the mean camera at the distance that the cameras are spread, at least
 * 1. 0, or -1: no memory. */
int ted4_view_box(const ted4_dataset *d, double centre[3], double *half);

#endif
