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
    TED4_RAY_FEW_POINTS = 1000,
    TED4_RAY_MANY_POINTS = 100000,
    TED4_RAY_MAX_SIDE = 4096,
    TED4_RAY_MAX_COUNT = 1000
};

/* RAY_NEU3D and RAY_CALIBRATION: one clip per camera, test cameras first. RAY_LLFF: a single time
 * with one still per camera, test cameras first. */
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
    int video; /* 1: clips are lossless videos, made by ffmpeg, instead of folders of frames */
    int hold;  /* training cameras lack time hold / 2 of every hold times; 0: none */
    double pose_error; /* pose error of training cameras in degrees, 0 to TED4_RAY_MOST_ERROR
                          (ray_rig.h) */
    double tint;  /* how much the colours of training cameras differ, 0 to TED4_RAY_MOST_TINT */
    double drift; /* stops by which the exposures of training cameras change over time, 0 to
                     TED4_RAY_MOST_DRIFT (ray_rig.h) */
    ted4_ray_ways ways;
} ted4_ray_options;

#define TED4_RAY_MOST_ERROR 10.0
#define TED4_RAY_MOST_TINT  2.0
#define TED4_RAY_MOST_DRIFT 2.0

/* Returns seed 1, layout blender, and the table's options of that scene. */
ted4_ray_options ted4_ray_defaults(ted4_ray_scene s);

typedef struct {
    char text[1200];
} ted4_ray_message;

/* A point on a surface that a training camera sees in a frame that is not held out. */
typedef struct {
    vec3 point; /* in the coordinates of the files */
    uint8_t rgb[3];
    int camera, frame;
} ted4_ray_point;

/* Returns the number of points of the initial cloud. */
int ted4_ray_n_points(const ted4_ray_options *o);

/* Returns point i of the initial cloud, determined by o and i. A point that lies on no surface has
 * no camera. */
ted4_ray_point ted4_ray_point_at(const ted4_ray_options *o, int i);

/* Returns one sentence that says which options do not go together, or NULL. */
const char *ted4_ray_fault(const ted4_ray_options *o);

/* Writes pictures, masks, cameras, points, and truth.json if there is anything to report
 * (ray_truth.h). The file by which a folder is recognised as a scene comes last. Makes folders as
 * needed and replaces files of the same names. Returns 0, or -1 with *m filled. The bytes do not
 * depend on p, except for videos, whose bytes are ffmpeg's. */
int ted4_ray_write(const ted4_ray_options *o, const char *folder, const ted4_parallel *p,
                   ted4_ray_message *m);

#endif
