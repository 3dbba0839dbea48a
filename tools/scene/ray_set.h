/* ray_set.h - writes a scene as a folder in one of the layouts that the encoder reads.
 * Depends on ray_render.h, ray_scene.h and base/parallel.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef RAY_SET_H
#define RAY_SET_H

#include "base/parallel.h"
#include "ray_render.h"
#include "ray_scene.h"

enum {
    TED4_RAY_POINTS = 4000,
    TED4_RAY_MANY_POINTS = 100000,
    TED4_RAY_MAX_SIDE = 4096,
    TED4_RAY_MAX_COUNT = 1000
};

/* RAY_NEU3D and RAY_CALIBRATION: cameras with a clip each, test cameras first. RAY_LLFF: of one
 * time only, a still a camera, test cameras first. */
typedef enum {
    RAY_BLENDER,
    RAY_NERFSTUDIO,
    RAY_COLMAP,
    RAY_COLMAP_TEXT,
    RAY_HYPERNERF,
    RAY_NEU3D,
    RAY_CALIBRATION,
    RAY_LLFF,
    RAY_LAYOUTS
} ted4_ray_layout;

/* "blender", "nerfstudio", "colmap", "colmap-text", "hypernerf", "neu3d", "calibration", "llff" */
const char *ted4_ray_layout_name(ted4_ray_layout l);

typedef struct {
    ted4_ray_scene scene;
    int width, height;             /* 8 to TED4_RAY_MAX_SIDE */
    int n_train, n_test, n_frames; /* 1 (n_test 0) to TED4_RAY_MAX_COUNT */
    uint32_t seed;
    ted4_ray_layout layout;
    int video;         /* clips as lossless videos, made by ffmpeg, not as folders of frames */
    int hold;          /* training cameras lack time hold / 2 of every hold; 0: none */
    double pose_error; /* of training cameras, degrees, 0 to TED4_RAY_MOST_ERROR (ray_rig.h) */
    double tint;       /* how much training cameras disagree in colour, 0 to TED4_RAY_MOST_TINT */
    ted4_ray_ways ways;
} ted4_ray_options;

#define TED4_RAY_MOST_ERROR 10.0
#define TED4_RAY_MOST_TINT  2.0

/* Seed 1, layout blender, the rest as the table of scenes has it. */
ted4_ray_options ted4_ray_defaults(ted4_ray_scene s);

typedef struct {
    char text[1200];
} ted4_ray_message;

/* A point on a surface that a training camera sees at a frame that is not held out. */
typedef struct {
    vec3 point; /* in the coordinates of the files */
    uint8_t rgb[3];
    int camera, frame;
} ted4_ray_point;

/* Points of the initial cloud. */
int ted4_ray_n_points(const ted4_ray_options *o);

/* Point i of them; o and i decide it. One that is on no surface has no camera. */
ted4_ray_point ted4_ray_point_at(const ted4_ray_options *o, int i);

/* What an option cannot go with, or NULL: one sentence. */
const char *ted4_ray_fault(const ted4_ray_options *o);

/* Pictures, masks, cameras, points; truth.json where there is something to say (ray_truth.h); last
 * the file without which a folder is not taken for a scene. Makes folders as needed, and replaces
 * files of the same names. 0, or -1 with *m filled. The bytes do not depend on p (those of videos
 * are ffmpeg's). */
int ted4_ray_write(const ted4_ray_options *o, const char *folder, const ted4_parallel *p,
                   ted4_ray_message *m);

#endif
