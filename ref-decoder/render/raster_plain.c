/* raster_plain.c - the reference implementation of the rasteriser. Source: annex I.2, I.3, with the
 * conventions of raster.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "render/raster_plain.h"

#include <math.h>
#include <stdlib.h>

typedef struct {
    size_t index;
    float depth;    /* in float, as in raster.c, so that the order by depth agrees */
    double x, y;    /* centre, pixels */
    double A, B, C; /* inverse of the 2D covariance [[A, B], [B, C]] */
    double opacity, colour[3];
} plain_splat;

/* Computes the 3x3 covariance R S S R^T. */
static void covariance3(const ted4_splats *s, size_t i, double cov[3][3])
{
    const double w = s->rot[0][i], x = s->rot[1][i], y = s->rot[2][i], z = s->rot[3][i];
    const double R[3][3] = {
        { 1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y) },
        { 2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x) },
        { 2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y) },
    };

    for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++) {
            cov[a][b] = 0;
            for (int k = 0; k < 3; k++) {
                const double scale = s->scale[k][i];
                cov[a][b] += R[a][k] * scale * scale * R[b][k];
            }
        }
}

/* Returns the slope x / z for the Jacobian, clamped to the guard band around the frustum along this
 * axis. */
static double clamp_slope(double slope, int size, double focal, double principal)
{
    const double half = 0.5 * size / focal, mid = half - principal / focal;

    return fmin(fmax(slope, mid - (double)TED4_RASTER_GUARD * half),
                mid + (double)TED4_RASTER_GUARD * half);
}

/* Returns a^T M b. */
static double form3(const double a[3], double M[3][3], const double b[3])
{
    double sum = 0;

    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            sum += a[i] * M[i][k] * b[k];
    return sum;
}

/* Projects Gaussian i. Returns 1 with *g filled if the Gaussian is beyond near_z and opaque enough
 * to be visible, else 0. */
static int project(const ted4_splats *s, const ted4_view *v, size_t i, plain_splat *g)
{
    double t[3], cov[3][3], j0[3], j1[3];

    for (int k = 0; k < 3; k++)
        t[k] = (double)v->R[3 * k] * s->mean[0][i] + (double)v->R[3 * k + 1] * s->mean[1][i] +
               (double)v->R[3 * k + 2] * s->mean[2][i] + v->t[k];
    if (t[2] <= v->near_z || s->opacity[i] < TED4_RASTER_ALPHA_MIN)
        return 0;

    const double u = clamp_slope(t[0] / t[2], v->width, v->fx, v->cx);
    const double w = clamp_slope(t[1] / t[2], v->height, v->fy, v->cy);
    for (int k = 0; k < 3; k++) {
        j0[k] = v->fx / t[2] * (v->R[k] - u * v->R[6 + k]);
        j1[k] = v->fy / t[2] * (v->R[3 + k] - w * v->R[6 + k]);
    }
    covariance3(s, i, cov);
    const double pixel = v->pixel > 0 ? v->pixel : 1, fine = 1 / (pixel * pixel);
    const double learnt = fine * (double)TED4_RASTER_BLUR;
    const double more = fmax(1 - fine, 0) * (double)TED4_RASTER_BOX;
    const double a0 = form3(j0, cov, j0) + learnt, c0 = form3(j1, cov, j1) + learnt;
    const double b = form3(j0, cov, j1), a = a0 + more, c = c0 + more, det = a * c - b * b;

    *g = (plain_splat) { .index = i,
                         .depth = (float)t[2],
                         .x = v->fx * t[0] / t[2] + v->cx,
                         .y = v->fy * t[1] / t[2] + v->cy,
                         .A = c / det,
                         .B = -b / det,
                         .C = a / det,
                         .opacity = s->opacity[i] * sqrt((a0 * c0 - b * b) / det),
                         .colour = { s->colour[0][i], s->colour[1][i], s->colour[2][i] } };
    return 1;
}

static int by_depth(const void *left, const void *right)
{
    const plain_splat *a = left, *b = right;

    if (a->depth != b->depth)
        return a->depth < b->depth ? -1 : 1;
    return a->index < b->index ? -1 : 1;
}

/* Computes the colour of the pixel with centre (x, y). */
static void blend(const plain_splat *g, size_t n, const ted4_view *v, double x, double y,
                  double colour[3])
{
    double T = 1;

    colour[0] = colour[1] = colour[2] = 0;
    for (size_t i = 0; i < n; i++) {
        const double dx = x - g[i].x, dy = y - g[i].y;
        const double e = 0.5 * (g[i].A * dx * dx + g[i].C * dy * dy) + g[i].B * dx * dy;
        const double alpha = fmin((double)TED4_RASTER_ALPHA_MAX, g[i].opacity * exp(-e));

        if (alpha < (double)TED4_RASTER_ALPHA_MIN)
            continue;
        if (T * (1 - alpha) < (double)TED4_RASTER_T_MIN)
            break;
        for (int k = 0; k < 3; k++)
            colour[k] += alpha * T * g[i].colour[k];
        T *= 1 - alpha;
    }
    for (int k = 0; k < 3; k++)
        colour[k] += T * v->background[k];
}

int ted4_raster_plain(const ted4_splats *s, const ted4_view *v, double *image)
{
    const size_t width = (size_t)v->width, height = (size_t)v->height;
    plain_splat *g = s->n < SIZE_MAX / sizeof *g ? malloc((s->n + 1) * sizeof *g) : NULL;
    size_t n = 0;

    if (g == NULL)
        return -1;
    for (size_t i = 0; i < s->n; i++)
        n += (size_t)project(s, v, i, &g[n]);
    qsort(g, n, sizeof *g, by_depth);

    for (size_t y = 0; y < height; y++)
        for (size_t x = 0; x < width; x++) {
            double colour[3];

            blend(g, n, v, (double)x + 0.5, (double)y + 0.5, colour);
            for (size_t k = 0; k < 3; k++)
                image[(k * height + y) * width + x] = colour[k];
        }
    free(g);
    return 0;
}
