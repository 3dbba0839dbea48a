/* ray_set.h - writes a scene as a folder in one of the layouts that the encoder reads.
 * Depends on ray_render.h and base/parallel.h. Used by ted4scene and the test.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef RAY_SET_H
#define RAY_SET_H

#include "base/parallel.h"
#include "ray_render.h"

enum { TED4_RAY_POINTS = 4000, TED4_RAY_MAX_SIDE = 4096, TED4_RAY_MAX_COUNT = 1000 };

/* RAY_NEU3D and RAY_CALIBRATION: cameras with a clip each, test cameras first. */
typedef enum {
    RAY_BLENDER, RAY_NERFSTUDIO, RAY_COLMAP, RAY_COLMAP_TEXT, RAY_HYPERNERF, RAY_NEU3D, RAY_CALIBRATION,
    RAY_LAYOUTS
} ted4_ray_layout;

/* "blender", "nerfstudio", "colmap", "colmap-text", "hypernerf", "neu3d", "calibration" */
const char *ted4_ray_layout_name(ted4_ray_layout l);

typedef struct {
    ted4_ray_scene scene;
    int      width, height;             /* 8 to TED4_RAY_MAX_SIDE */
    int      n_train, n_test, n_frames; /* 1 (n_test 0) to TED4_RAY_MAX_COUNT */
    uint32_t seed;
    ted4_ray_layout layout;
    int      video;                     /* clips as lossless videos, made by ffmpeg, not as folders of frames */
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

/* Pictures, cameras, points; last the file without which a folder is not taken for a scene. Makes
 * folders as needed, and replaces files of the same names. 0, or -1 with *m filled. The bytes do not
 * depend on p (those of videos are ffmpeg's). */
int ted4_ray_write(const ted4_ray_options *o, const char *folder, const ted4_parallel *p,
                   ted4_ray_message *m);

#endif
