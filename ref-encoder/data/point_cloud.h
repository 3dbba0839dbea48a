/* point_cloud.h - initial points of a scene: from a PLY file, or random where none came with it.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_POINT_CLOUD_H
#define TED4_POINT_CLOUD_H

#include <stddef.h>
#include <stdint.h>
#include "data/dataset.h"

typedef struct {
    float *xyz;   /* owned, [n][3] world */
    uint8_t *rgb; /* owned, [n][3] */
    size_t n;
} ted4_point_cloud;

#define TED4_POINT_GREY 128 /* colour of points that have none */

/* Zeroed room for n points. 0, or -1: no memory. */
int ted4_point_cloud_alloc(ted4_point_cloud *c, size_t n);
void ted4_point_cloud_free(ted4_point_cloud *c);

/* Ascii or binary little-endian PLY whose first element is "vertex" with x y z of any type; red
 * green blue of an integer type are 0..255, of a float type 0..1 or, when any exceeds 1, 0..255;
 * absent: grey. Other properties are skipped. */
int ted4_ply_read(ted4_point_cloud *c, const char *path, ted4_message *m);

/* The first of the usual names (see point_cloud.c) that exists in
 * folder. 0 with c->n == 0: none does. */
int ted4_ply_find(ted4_point_cloud *c, const char *folder, ted4_message *m);

#define TED4_RANDOM_POINTS 20000

/* Uniform in the box centre +- half, grey. Same seed, same points. 0, or -1: no memory. */
int ted4_point_cloud_random(ted4_point_cloud *c, const double centre[3], double half,
                            uint32_t seed);

#endif
