/* raw_scene.h - what every layout is read into before it becomes a ted4_dataset: a list of shots
 * and a point cloud. A loader (load_*.c) fills a ted4_raw_scene; build_dataset.c turns it into
 * frames, cameras, split and cache, the same for all layouts. A new layout needs one load_*.c
 * and one line in the table of dataset.c.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_RAW_SCENE_H
#define TED4_RAW_SCENE_H

#include <stddef.h>
#include "data/data_util.h"
#include "data/point_cloud.h"
#include "data/undistort.h"

/* Where no list says which pictures are held out: those whose index in the list sorted by name
 * is PHASE modulo EVERY. */
#define TED4_HOLD_OUT_EVERY 8
#define TED4_HOLD_OUT_PHASE 4

typedef struct {
    char *path;   /* owned; exists and has a readable header */
    char *camera; /* owned; label of the physical camera. NULL: cameras are told apart by pose */
    int is_posed; /* the label was made of the pose */
    int width, height; /* of the file */
    int has_alpha;
    int orientation;   /* as ted4_exif_orientation; pixels stay as stored, whatever it is */
    ted4_lens lens;    /* may state another size than the file's */
    double R[9], t[3]; /* world to camera, right-down-forward; R a clean rotation */
    double time;       /* any unit and origin; equal times are one frame */
    int is_test;
} ted4_shot;

typedef struct {
    const ted4_dataset_options
        *wanted;        /* borrowed; for layouts that can read less than everything */
    const char *layout; /* static text */
    ted4_shot *shots;   /* owned, in the layout's order */
    size_t n_shots, capacity;
    ted4_point_cloud cloud; /* empty: none came with the scene */
    int reduced;   /* downscale counts from pictures this many times finer than the files; 0 or 1:
                      from these */
    int unit_cube; /* random points fill the cube of Blender's synthetic scenes */
    int timed;     /* times came with the pictures */
    double rate;   /* frames a second, 0: unknown */
    size_t n_entries, n_missing; /* listed, and of these without a picture */
    char first_missing[700];
    char **warnings; /* [n_warnings] owned, as those of a dataset */
    size_t n_warnings;
} ted4_raw_scene;

void ted4_raw_scene_free(ted4_raw_scene *s);

/* Appends a shot for a picture file, which it opens to read the size; takes path over, in
 * failure too. where names the entry for the message. The lens is a pinhole of the file's size
 * without focal length; pose and time are zero. NULL with *m filled. */
ted4_shot *ted4_raw_scene_add(ted4_raw_scene *s, char *path, const char *where, ted4_message *m);

/* The same for an entry of a list, which may name a picture that is not there: such entries are
 * counted and left out. 1, or 0 with *shot NULL: left out, or -1 with *m filled. */
int ted4_raw_scene_list(ted4_raw_scene *s, char *path, const char *where, ted4_shot **shot,
                        ted4_message *m);

/* Counts an entry whose picture is missing; keeps what the first one says. */
void ted4_raw_scene_missing(ted4_raw_scene *s, const char *where, const char *name);

/* Appends a warning. 0, or -1: no memory. */
#define ted4_raw_scene_warn(s, ...) ted4_text_add(&(s)->warnings, &(s)->n_warnings, __VA_ARGS__)

/* Marks shots as test by TED4_HOLD_OUT_*; they must be sorted by name. */
void ted4_raw_scene_hold_out(ted4_raw_scene *s);

/* hold_out.c: gives shots without a label one that tells their pose. 0, or -1: no memory. */
int ted4_raw_scene_label(ted4_raw_scene *s);

/* Marks the shots of the cameras that o names as test, and no others; all have labels. 0, or -1
 * with *m filled. */
int ted4_raw_scene_hold_out_named(ted4_raw_scene *s, const ted4_dataset_options *o,
                                  ted4_message *m);

typedef int ted4_loader(ted4_raw_scene *s, const char *folder, ted4_message *m);

/* 0, or -1 with *m filled; *s must be zero but for wanted before and is to be freed by the caller
 * either way. */
ted4_loader ted4_load_colmap, ted4_load_transforms, ted4_load_hypernerf, ted4_load_neu3d,
    ted4_load_llff, ted4_load_calibration;

/* Does the folder look like the layout? */
int ted4_is_colmap(const char *folder);
int ted4_is_transforms(const char *folder);
int ted4_is_hypernerf(const char *folder);
int ted4_is_neu3d(const char *folder);
int ted4_is_llff(const char *folder);
int ted4_is_calibration(const char *folder);

/* Takes shots and cloud out of *s. 0, or -1 with *m filled and *d to be freed by the caller. */
int ted4_build_dataset(ted4_dataset *d, ted4_raw_scene *s, const ted4_dataset_options *o,
                       ted4_message *m);

/* frame_times.c: frame[i] of each of n times, *n_frames, at most TED4_MAX_FRAMES. Times without a
 * common step move to the nearest frame. 0, or -1: no memory, *m says so. */
#define TED4_MAX_FRAMES 36000
/* Sorts t[n], n > 0, and keeps one of each group of equal times, the last; returns how many. */
size_t ted4_distinct_times(double *t, size_t n);
int ted4_frame_times(const double *time, size_t n, uint32_t *frame, uint32_t *n_frames,
                     ted4_message *m);

#endif
