/* view_geometry.h - where points in normalised space lie in the pictures of a view, and points on
 * the rays through its pixels. Functions of single points, which loops over lanes may contain.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_VIEW_GEOMETRY_H
#define TED4_VIEW_GEOMETRY_H

#include <stddef.h>

#include "render/raster.h"

/* Projects the point p0, p1, p2. Returns the depth, and gives the place in the picture in pixels,
 * which means something only if the depth is beyond near_z. */
static inline float ted4_view_project(const ted4_view *v, float p0, float p1, float p2, float *x,
                                      float *y)
{
    const float z = v->R[6] * p0 + v->R[7] * p1 + v->R[8] * p2 + v->t[2];

    *x = v->fx * (v->R[0] * p0 + v->R[1] * p1 + v->R[2] * p2 + v->t[0]) / z + v->cx;
    *y = v->fy * (v->R[3] * p0 + v->R[4] * p1 + v->R[5] * p2 + v->t[1]) / z + v->cy;
    return z;
}

/* Returns whether what is projected to these values lies in the picture. The operators are those of
 * lanes: no operand is left out. */
static inline int ted4_view_holds(const ted4_view *v, float x, float y, float z)
{
    return (z > v->near_z) & (x >= 0) & (y >= 0) & (x < (float)v->width) & (y < (float)v->height);
}

/* Projects p. Fills the pixel number (row major) and the depth. Returns 0 if the point lies outside
 * the picture, else 1. */
static inline int ted4_view_pixel(const ted4_view *v, const float p[3], size_t *pixel, float *depth)
{
    float x, y;
    const float z = ted4_view_project(v, p[0], p[1], p[2], &x, &y);

    if (!ted4_view_holds(v, x, y, z))
        return 0;
    *pixel = (size_t)y * (size_t)v->width + (size_t)x;
    *depth = z;
    return 1;
}

/* Gives the ray through a pixel's centre: x and y of its point at depth 1, camera space. */
static inline void ted4_view_ray(const ted4_view *v, int column, int row, float ray[2])
{
    ray[0] = ((float)column + 0.5f - v->cx) / v->fx;
    ray[1] = ((float)row + 0.5f - v->cy) / v->fy;
}

/* Computes the point p at depth z on a ray. */
static inline void ted4_ray_point(const ted4_view *v, const float ray[2], float z, float p[3])
{
    const float x = ray[0] * z - v->t[0], y = ray[1] * z - v->t[1], d = z - v->t[2];

    for (int k = 0; k < 3; k++)
        p[k] = v->R[k] * x + v->R[3 + k] * y + v->R[6 + k] * d;
}

#endif
