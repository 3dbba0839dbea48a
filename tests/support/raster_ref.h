/* raster_ref.h - the image model of render/raster.h for Gaussians in double precision:
 * raster_plain.h takes them in float, which is too coarse for finite differences through a whole
 * training step.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_RASTER_REF_H
#define TED4_RASTER_REF_H

#include <math.h>
#include <stdlib.h>

#include "render/raster.h"

enum { REF_SPLATS = 256, REF_SPLAT = 14 }; /* mean 3, scale 3, rotation 4, opacity, colour 3 */

typedef struct {
    double depth, centre[2], conic[3], opacity, colour[3];
} ref_footprint;

static inline void ref_axes(const double *q, double axis[3][3])
{
    const double w = q[0], x = q[1], y = q[2], z = q[3];

    axis[0][0] = 1 - 2 * (y * y + z * z);
    axis[0][1] = 2 * (x * y + w * z);
    axis[0][2] = 2 * (x * z - w * y);
    axis[1][0] = 2 * (x * y - w * z);
    axis[1][1] = 1 - 2 * (x * x + z * z);
    axis[1][2] = 2 * (y * z + w * x);
    axis[2][0] = 2 * (x * z + w * y);
    axis[2][1] = 2 * (y * z - w * x);
    axis[2][2] = 1 - 2 * (x * x + y * y);
}

static inline double ref_guarded(double slope, double size, double focal, double principal)
{
    const double middle = (0.5 * size - principal) / focal;
    const double reach = (double)TED4_RASTER_GUARD * 0.5 * size / focal;

    return fmin(fmax(slope, middle - reach), middle + reach);
}

/* The screen-space covariance is the sum over the Gaussian's axes a of (s J R a)(s J R a)^T.
 * Returns 0 if the Gaussian is culled. */
static inline int ref_footprint_of(const ted4_view *v, const double *splat, ref_footprint *f)
{
    const double blur = (double)TED4_RASTER_BLUR;
    double t[3], axis[3][3], x[3], y[3], xx = blur, xy = 0, yy = blur, det = blur * blur;

    for (int i = 0; i < 3; i++) {
        t[i] = (double)v->t[i];
        for (int j = 0; j < 3; j++)
            t[i] += (double)v->R[3 * i + j] * splat[j];
    }
    if (t[2] <= (double)v->near_z || splat[10] < (double)TED4_RASTER_ALPHA_MIN)
        return 0;
    const double fx = (double)v->fx, fy = (double)v->fy;
    const double u = ref_guarded(t[0] / t[2], v->width, fx, (double)v->cx);
    const double w = ref_guarded(t[1] / t[2], v->height, fy, (double)v->cy);

    ref_axes(splat + 6, axis);
    for (int k = 0; k < 3; k++) {
        double c[3] = { 0, 0, 0 };

        for (int i = 0; i < 3; i++)
            for (int j = 0; j < 3; j++)
                c[i] += (double)v->R[3 * i + j] * axis[k][j] * splat[3 + k];
        x[k] = fx / t[2] * (c[0] - u * c[2]);
        y[k] = fy / t[2] * (c[1] - w * c[2]);
        xx += x[k] * x[k];
        xy += x[k] * y[k];
        yy += y[k] * y[k];
        det += blur * (x[k] * x[k] + y[k] * y[k]);
    }
    /* xx yy - xy xy by Lagrange's identity, which keeps the precision for long thin Gaussians. */
    for (int k = 0; k < 3; k++) {
        const double cross = x[k] * y[(k + 1) % 3] - x[(k + 1) % 3] * y[k];

        det += cross * cross;
    }

    *f = (ref_footprint) { t[2],
                           { fx * t[0] / t[2] + (double)v->cx, fy * t[1] / t[2] + (double)v->cy },
                           { yy / det, -xy / det, xx / det },
                           splat[10],
                           { splat[11], splat[12], splat[13] } };
    return 1;
}

static inline int ref_by_depth(const void *a, const void *b)
{
    const double x = ((const ref_footprint *)a)->depth, y = ((const ref_footprint *)b)->depth;

    return x < y ? -1 : x > y;
}

static inline void ref_blend(const ref_footprint *f, size_t n, const ted4_view *v, double x,
                             double y, double *colour)
{
    double through = 1;

    for (int c = 0; c < 3; c++)
        colour[c] = 0;
    for (size_t i = 0; i < n; i++) {
        const double dx = x - f[i].centre[0], dy = y - f[i].centre[1];
        const double e = 0.5 * (f[i].conic[0] * dx * dx + f[i].conic[2] * dy * dy) +
                         f[i].conic[1] * dx * dy;
        const double alpha = e > 6 ? 0
                                   : fmin((double)TED4_RASTER_ALPHA_MAX, f[i].opacity * exp(-e));

        if (alpha < (double)TED4_RASTER_ALPHA_MIN)
            continue;
        if (through * (1 - alpha) < (double)TED4_RASTER_T_MIN)
            break;
        for (int c = 0; c < 3; c++)
            colour[c] += through * alpha * f[i].colour[c];
        through *= 1 - alpha;
    }
    for (int c = 0; c < 3; c++)
        colour[c] += through * (double)v->background[c];
}

/* image: planar [3][height][width]. n <= REF_SPLATS. Returns the number of Gaussians that were not
 * culled. */
static inline size_t ref_render(const ted4_view *v, const double (*splat)[REF_SPLAT], size_t n,
                                double *image)
{
    ref_footprint f[REF_SPLATS];
    const size_t width = (size_t)v->width, height = (size_t)v->height;
    size_t kept = 0;

    for (size_t i = 0; i < n; i++)
        kept += (size_t)ref_footprint_of(v, splat[i], &f[kept]);
    qsort(f, kept, sizeof f[0], ref_by_depth);
    for (size_t y = 0; y < height; y++)
        for (size_t x = 0; x < width; x++) {
            double colour[3];

            ref_blend(f, kept, v, (double)x + 0.5, (double)y + 0.5, colour);
            for (size_t c = 0; c < 3; c++)
                image[(c * height + y) * width + x] = colour[c];
        }
    return kept;
}

#endif
