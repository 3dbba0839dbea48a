/* raw_scene.h - intermediate form of a scene, common to all layouts: a list of shots and a point
 * cloud. A loader (load_*.c) fills a ted4_raw_scene, and build_dataset.c turns it into a
 * ted4_dataset: frames, cameras, split and cache. A new layout needs one load_*.c and one line in
 * the table of dataset.c.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_RAW_SCENE_H
#define TED4_RAW_SCENE_H

#include <stddef.h>
#include "data/data_util.h"
#include "data/point_cloud.h"
#include "data/undistort.h"

/* Default split, where no list names the held-out pictures: a picture is test if its index in the
 * list sorted by name is PHASE modulo EVERY. */
#define TED4_HOLD_OUT_EVERY 8
#define TED4_HOLD_OUT_PHASE 4

typedef struct {
    char *path; /* owned; the file exists and has a readable header */
    /* camera: owned; label of the physical camera. NULL: cameras are told apart by their poses */
    char *camera;
    int is_posed;      /* the label was derived from the pose */
    int width, height; /* size of the file */
    int has_alpha;
    int orientation;   /* as ted4_exif_orientation; informative only, pixels are never rotated */
    ted4_lens lens;    /* may be given for another size than the file's */
    double R[9], t[3]; /* world to camera, axes right, down, forward; R is orthonormal */
    double time;       /* in any unit, from any origin; shots of equal times form a frame */
    int is_test;
} ted4_shot;

typedef struct {
    const ted4_dataset_options *wanted; /* borrowed; lets a loader read less than everything */
    const char *layout;                 /* static text */
    ted4_shot *shots;                   /* owned; in the order of the layout */
    size_t n_shots, capacity;
    ted4_point_cloud cloud; /* empty: the scene has no points */
    /* reduced: the files are already reduced by this factor, relative to the pictures that the
     * option downscale refers to; 0 or 1: not reduced */
    int reduced;
    int unit_cube; /* random points fill the cube used by Blender's synthetic scenes */
    int timed;     /* the layout gives the times of pictures */
    double rate;   /* frames per second; 0: unknown */
    /* Number of entries in the layout's list, and of those whose picture does not exist. */
    size_t n_entries, n_missing;
    char first_missing[700];
    char **warnings; /* [n_warnings] owned; as in ted4_dataset */
    size_t n_warnings;
} ted4_raw_scene;

void ted4_raw_scene_free(ted4_raw_scene *s);

/* Appends a shot for a picture file, which is opened to read its size. Takes ownership of path, on
 * failure too. where names the entry in error messages. The lens is set to a pinhole of the file's
 * size without a focal length; pose and time are zero. Returns NULL with *m filled on failure. */
ted4_shot *ted4_raw_scene_add(ted4_raw_scene *s, char *path, const char *where, ted4_message *m);

/* Like ted4_raw_scene_add, but for an entry of a list that may name a picture that does not exist,
 * or a pipe and the like. Such entries are counted and skipped. Returns 1, or 0 with *shot NULL if
 * the entry was skipped, or -1 with *m filled. */
int ted4_raw_scene_list(ted4_raw_scene *s, char *path, const char *where, ted4_shot **shot,
                        ted4_message *m);

/* Counts an entry whose picture is missing, and keeps where and name of the first one. */
void ted4_raw_scene_missing(ted4_raw_scene *s, const char *where, const char *name);

/* Appends a warning. Returns 0, or -1 if memory runs out. */
#define ted4_raw_scene_warn(s, ...) ted4_text_add(&(s)->warnings, &(s)->n_warnings, __VA_ARGS__)

/* Applies the default split (TED4_HOLD_OUT_*). The shots must be sorted by name. */
void ted4_raw_scene_hold_out(ted4_raw_scene *s);

/* hold_out.c: labels the shots that have no camera label by their pose. Returns 0, or -1 if memory
 * runs out. */
int ted4_raw_scene_label(ted4_raw_scene *s);

/* hold_out.c: returns what a camera is called for short, and its length *n. COLMAP's labels read
 * NUMBER/FOLDER/; the folder alone is enough as a name, or the number if there is no folder. */
const char *ted4_camera_name(const char *label, size_t *n);

/* hold_out.c: marks exactly the shots of the cameras named in o->hold_out as test. All shots must
 * have labels. Returns 0, or -1 with *m filled. */
int ted4_raw_scene_hold_out_named(ted4_raw_scene *s, const ted4_dataset_options *o,
                                  ted4_message *m);

typedef int ted4_loader(ted4_raw_scene *s, const char *folder, ted4_message *m);

/* Loaders, one per layout. On entry *s must be zero except for wanted. Returns 0, or -1 with *m
 * filled; the caller frees *s in either case. */
ted4_loader ted4_load_colmap, ted4_load_transforms, ted4_load_hypernerf, ted4_load_neu3d,
    ted4_load_llff, ted4_load_calibration;

/* Does the folder look like a scene of the layout? */
int ted4_is_colmap(const char *folder);
int ted4_is_transforms(const char *folder);
int ted4_is_hypernerf(const char *folder);
int ted4_is_neu3d(const char *folder);
int ted4_is_llff(const char *folder);
int ted4_is_calibration(const char *folder);

/* Turns *s into *d and takes over its shots and point cloud. Returns 0, or -1 with *m filled; then
 * the caller must free *d. */
int ted4_build_dataset(ted4_dataset *d, ted4_raw_scene *s, const ted4_dataset_options *o,
                       ted4_message *m);

#define TED4_MAX_FRAMES 36000
/* frame_times.c: sorts t[n], n > 0, and keeps only the largest time of each group of equal times.
 * Returns the number of groups. */
size_t ted4_distinct_times(double *t, size_t n);
/* frame_times.c: gives the frame index frame[i] of each of n times, and their number *n_frames, at
 * most TED4_MAX_FRAMES. Times without a common step move to the nearest frame. Returns 0, or -1
 * with *m filled if memory runs out. */
int ted4_frame_times(const double *time, size_t n, uint32_t *frame, uint32_t *n_frames,
                     ted4_message *m);

#endif
