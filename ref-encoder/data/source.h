/* source.h - converts the file of one picture to pixels, and finds where a scene's cameras look.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_SOURCE_H
#define TED4_SOURCE_H

#include "data/dataset.h"
#include "data/image_cache.h"
#include "data/undistort.h"

typedef struct ted4_source {
    const char *path; /* borrowed from the picture */
    ted4_lens lens;   /* lens of the file, at the file's size */
    int downscale;
    uint8_t background;    /* grey level under transparent pixels */
    uint8_t premultiplied; /* same as the option */
    size_t n_partial;      /* partly transparent pixels in the last decoding */
    size_t n_above;        /* of these, pixels with a colour above alpha: not premultiplied */
    int is_known;          /* decoded before; a file with another digest is refused */
    uint64_t digest;
    double level; /* mean of all bytes; 0 before ted4_dataset_verify */
} ted4_source;

/* A ted4_image_decoder whose user is an array of sources. It converts the file to RGB by
 * compositing, undistorting and downscaling, in this order, and refuses files that were replaced
 * since they were first decoded. */
uint8_t *ted4_source_decode(void *sources, size_t i, size_t *size, ted4_message *m);

/* Half the side of the cube of random points of a Blender scene; the synthetic objects are made to
 * fit this cube. */
#define TED4_BLENDER_HALF_CUBE 1.3

#define TED4_VIEW_BOX_HALF_SIDE 0.6 /* of the median distance of the cameras */

/* Gives the cube at which the cameras of training pictures look. Its centre is the point nearest to
 * all optical axes in the least-squares sense, and half its side is 0.6 times the median distance
 * of the cameras from the centre. If the axes have no common point in front of the cameras (one
 * camera, parallel or diverging axes, cameras that turn about themselves), their depth is unknown,
 * and is taken for the spread of the cameras, but at least 1. The centre then lies at that depth in
 * front of the mean camera, or at the mean camera if the cameras look all around, and half the side
 * is 0.6 times the median distance from the centre either of the cameras or of the places at that
 * depth on their axes, whichever is larger. Returns 0, or -1 if memory runs out. */
int ted4_view_box(const ted4_dataset *d, double centre[3], double *half);

#endif
