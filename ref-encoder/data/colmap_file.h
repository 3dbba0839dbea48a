/* colmap_file.h - reader for COLMAP's sparse model (cameras, images and points3D), binary or text.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_COLMAP_FILE_H
#define TED4_COLMAP_FILE_H

#include <stddef.h>
#include <stdint.h>
#include "data/dataset.h"
#include "data/point_cloud.h"
#include "data/undistort.h"

typedef struct {
    uint32_t id;
    ted4_lens lens;
} ted4_colmap_camera;

typedef struct {
    char *name;        /* owned; relative to images/ */
    uint32_t camera;   /* id */
    double R[9], t[3]; /* world to camera */
} ted4_colmap_image;

typedef struct {
    ted4_colmap_camera *cameras; /* owned */
    ted4_colmap_image *images;   /* owned, sorted by name */
    size_t n_cameras, n_images;
    ted4_point_cloud cloud; /* empty if the model has no points3D file */
} ted4_colmap;

/* Reads the model in a folder, which must hold cameras.bin or cameras.txt. Each of the three files
 * may be binary or text; binary is preferred. Counts are checked against the file's size before
 * anything is allocated. Returns 0, or -1 with *m filled. The caller must free *c in either
 * case. */
int ted4_colmap_read(ted4_colmap *c, const char *folder, ted4_message *m);
void ted4_colmap_free(ted4_colmap *c);

/* ---- colmap_model.c: shared by the two encodings ---- */

/* Looks up a camera model by COLMAP's number or name, and gives its number of parameters. Returns
 * the model, or -1 with *m filled if it is unknown or its lens cannot be undistorted here. where
 * names the camera in messages. */
int ted4_colmap_model_by_id(int64_t id, const char *where, size_t *n_parameters, ted4_message *m);
int ted4_colmap_model_by_name(const char *name, const char *where, size_t *n_parameters,
                              ted4_message *m);

#define TED4_COLMAP_MAX_PARAMETERS 8

/* Fills the lens of *c. The parameters are in COLMAP's order. Returns 0, or -1 with *m filled. */
int ted4_colmap_set_camera(ted4_colmap_camera *c, int model, uint64_t width, uint64_t height,
                           const double *parameters, const char *where, ted4_message *m);

/* Fills R and t from a quaternion (w x y z) and a translation. Returns 0, or -1 with *m filled. */
int ted4_colmap_set_pose(ted4_colmap_image *i, const double qt[7], const char *where,
                         ted4_message *m);

/* Makes room for one more record at the end of an array of n, doubling its size when needed.
 * Returns 0, or -1 if memory runs out. */
int ted4_colmap_reserve(void **array, size_t n, size_t record_size);

/* ---- colmap_bin.c, colmap_txt.c ---- */

/* Each function reads one file of the model in one encoding. Returns 0, or -1 with *m filled. */
int ted4_colmap_bin_cameras(ted4_colmap *c, const char *path, ted4_message *m);
int ted4_colmap_bin_images(ted4_colmap *c, const char *path, ted4_message *m);
int ted4_colmap_bin_points(ted4_colmap *c, const char *path, ted4_message *m);
int ted4_colmap_txt_cameras(ted4_colmap *c, const char *path, ted4_message *m);
int ted4_colmap_txt_images(ted4_colmap *c, const char *path, ted4_message *m);
int ted4_colmap_txt_points(ted4_colmap *c, const char *path, ted4_message *m);

#endif
