/* poses_bounds.h - poses_bounds.npy of LLFF, one row a camera: a 3x5 matrix row-major - columns
 * down, right, back, centre in the world, and (height, width, focal length in pixels) - and two
 * bounds of depth, not used.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_POSES_BOUNDS_H
#define TED4_POSES_BOUNDS_H

#include "data/raw_scene.h"

typedef struct {
    char *path;    /* owned */
    double *poses; /* [rows][17]; owned */
    size_t rows;
} ted4_poses_bounds;

int ted4_is_poses_bounds(const char *folder);

/* 0, or -1 with *m filled; free in both cases. */
int ted4_poses_bounds_read(ted4_poses_bounds *p, const char *folder, ted4_message *m);
void ted4_poses_bounds_free(ted4_poses_bounds *p);

/* Lens and pose of a row. 0, or -1 with *m filled. */
int ted4_poses_bounds_camera(const ted4_poses_bounds *p, size_t row, ted4_shot *shot,
                             ted4_message *m);

#endif
