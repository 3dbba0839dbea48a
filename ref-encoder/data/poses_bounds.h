/* poses_bounds.h - reads LLFF's poses_bounds.npy. Each row is one camera: a row-major 3x5 matrix,
 * whose columns are down, right, back and centre in the world and (height, width, focal length in
 * pixels), followed by two depth bounds, which are not used.
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

/* Returns 0, or -1 with *m filled. The caller must free *p in either case. */
int ted4_poses_bounds_read(ted4_poses_bounds *p, const char *folder, ted4_message *m);
void ted4_poses_bounds_free(ted4_poses_bounds *p);

/* Gives lens and pose of a row. Returns 0, or -1 with *m filled. */
int ted4_poses_bounds_camera(const ted4_poses_bounds *p, size_t row, ted4_shot *shot,
                             ted4_message *m);

#endif
