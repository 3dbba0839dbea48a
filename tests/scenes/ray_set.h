/* ray_set.h - writes a scene as a folder in the D-NeRF (Blender) layout.
 * Depends on ray_render.h and base/parallel.h. Used by ted4scene and the test.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef RAY_SET_H
#define RAY_SET_H

#include "base/parallel.h"
#include "ray_render.h"

enum { TED4_RAY_POINTS = 4000, TED4_RAY_MAX_SIDE = 4096, TED4_RAY_MAX_COUNT = 1000 };

typedef struct {
    ted4_ray_scene scene;
    int      width, height;             /* 8 to TED4_RAY_MAX_SIDE */
    int      n_train, n_test, n_frames; /* 1 (n_test 0) to TED4_RAY_MAX_COUNT */
    uint32_t seed;
} ted4_ray_options;

typedef struct { char text[1200]; } ted4_ray_message;

/* A point on a surface that a training camera sees at a frame. */
typedef struct {
    vec3    point;
    uint8_t rgb[3];
    int     camera, frame;
} ted4_ray_point;

/* Point i of the initial cloud; o and i decide it. */
ted4_ray_point ted4_ray_point_at(const ted4_ray_options *o, int i);

/* Writes folder/{train,test}/r_CCC_FF.png, points3d.ply and, last, transforms_{train,test}.json;
 * makes folders as needed, and replaces files of the same names. 0, or -1 with *m filled. The
 * bytes do not depend on p. */
int ted4_ray_write(const ted4_ray_options *o, const char *folder, const ted4_parallel *p,
                   ted4_ray_message *m);

#endif
