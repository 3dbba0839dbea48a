/* point_cloud.h - initial points of a scene, from a PLY file, or random if the scene has none.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_POINT_CLOUD_H
#define TED4_POINT_CLOUD_H

#include <stddef.h>
#include <stdint.h>
#include "data/dataset.h"

typedef struct {
    float *xyz;   /* owned, [n][3] world coordinates */
    uint8_t *rgb; /* owned, [n][3] */
    size_t n;
} ted4_point_cloud;

#define TED4_POINT_GREY 128 /* colour of points that have none */

/* Allocates n points, all zero. Returns 0, or -1 if memory runs out. */
int ted4_point_cloud_alloc(ted4_point_cloud *c, size_t n);
void ted4_point_cloud_free(ted4_point_cloud *c);

/* Reads an ASCII or binary little-endian PLY file whose first element is "vertex" with x y z of any
 * type. red green blue (or diffuse_red and so on, or r g b) of an integer type are 0..255, or
 * 0..65535 if any exceeds 255; of a float type they are 0..1, or 0..255 if any exceeds 1. Points
 * without colours are grey. Other properties are skipped. Returns 0, or -1 with *m filled. */
int ted4_ply_read(ted4_point_cloud *c, const char *path, ted4_message *m);

/* Reads the first file in folder that has one of the usual names (see point_cloud.c). Returns 0,
 * also with c->n == 0 if there is none, or -1 with *m filled. */
int ted4_ply_find(ted4_point_cloud *c, const char *folder, ted4_message *m);

#define TED4_RANDOM_POINTS 20000

/* Fills c with grey points, uniformly distributed in the box centre +- half. Equal seeds give equal
 * points. Returns 0, or -1 if memory runs out. */
int ted4_point_cloud_random(ted4_point_cloud *c, const double centre[3], double half,
                            uint32_t seed);

#endif
