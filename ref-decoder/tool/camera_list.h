/* camera_list.h - reads cameras.json, the list of views that ted4dec renders.
 * The file is a list of objects. Each has width, height, fx, fy, cx and cy in pixels, with pixel
 * centres at + 0.5; R (9 numbers, row by row) and t (3 numbers), so that x_cam = R x + t with the
 * axes right, down, forward; pixel, as in ted4_view, or nothing for 1; and frame (a number), time
 * (a number in [0, 1], or a string in the form that --time accepts), or neither: a camera of all
 * times. A transforms file is taken as well (camera_transforms.h).
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_CAMERA_LIST_H
#define TED4_CAMERA_LIST_H

#include <stddef.h>
#include <stdio.h>

#include "render/raster.h"
#include "times.h"

typedef struct {
    ted4_view view; /* near_z and background are not set */
    int has_frame;  /* 1: frame is valid; 0: time is valid */
    uint32_t frame;
    ted4_time time; /* den 0: the camera belongs to all times */
} ted4_listed_camera;

typedef struct {
    ted4_listed_camera *camera; /* owned */
    size_t n;
    int distorted; /* 1: the file says that lenses are distorted, which the views are not */
} ted4_camera_list;

/* What to say of a list that is distorted. */
#define TED4_CAMERA_LIST_DISTORTED "lens distortion is left out: cameras become those of a pinhole"

/* Returns 0, or -1 with why filled and the list empty. */
int ted4_camera_list_load(ted4_camera_list *l, const char *path, char *why, size_t why_size);
void ted4_camera_list_free(ted4_camera_list *l);
/* Prints a list of at least one camera in the form that ted4_camera_list_load reads. */
void ted4_camera_list_print(const ted4_camera_list *l, FILE *f);

#endif
