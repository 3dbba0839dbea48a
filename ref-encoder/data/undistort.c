/* undistort.c - see undistort.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "data/undistort.h"

#include <math.h>
#include <stddef.h>

int ted4_lens_is_pinhole(const ted4_lens *l)
{
    return l->k1 == 0 && l->k2 == 0 && l->p1 == 0 && l->p2 == 0 && l->k3 == 0 && l->skew == 0;
}

/* Returns d/dr (r + k1 r^3 + k2 r^5 + k3 r^7) at s = r^2. */
static double slope(const ted4_lens *l, double s)
{
    return 1 + s * (3 * l->k1 + s * (5 * l->k2 + s * 7 * l->k3));
}

/* Returns the first zero of the slope if k3 is not 0. The slope is monotone between 0, its extrema
 * (the roots of 3 k1 + 10 k2 s + 21 k3 s^2) and FAR, so the zero lies in the first of these pieces
 * that ends below zero. */
static double cubic_fold(const ted4_lens *l)
{
    const double FAR = 1e6, disc = 25 * l->k2 * l->k2 - 63 * l->k1 * l->k3;
    const double half = disc > 0 ? sqrt(disc) / fabs(21 * l->k3) : 0,
                 middle = -5 * l->k2 / (21 * l->k3);
    const double ends[3] = { middle - half, middle + half, FAR };
    double low = 0;

    for (int i = 0; i < 3; i++) {
        double high = ends[i];
        if (!(high > low && high <= FAR))
            continue;
        if (slope(l, high) > 0) {
            low = high;
            continue;
        }
        for (int k = 0; k < 100; k++) {
            const double s = 0.5 * (low + high);
            *(slope(l, s) > 0 ? &low : &high) = s;
        }
        return low;
    }
    return INFINITY;
}

/* Returns the squared radius at which the slope first reaches zero, or infinity if it never
 * does. */
static double fold_radius2(const ted4_lens *l)
{
    if (l->k3 != 0)
        return cubic_fold(l);
    /* Solves 1 + 3 k1 s + 5 k2 s^2 = 0. */
    const double a = 5 * l->k2, b = 3 * l->k1, disc = b * b - 4 * a;

    if (disc < 0)
        return INFINITY;
    /* The roots are 2 / (-b +- sqrt(disc)), which is valid for a = 0, too. The larger denominator
     * gives the smaller positive root. */
    const double q = -b + sqrt(disc);
    return q > 0 ? 2 / q : INFINITY;
}

/* Gives the position in the distorted picture, in pixels, of the ray that a pinhole camera with the
 * same fx fy cx cy and without skew sees at (x, y). Beyond the radius at which the radial
 * polynomial stops growing (and would fold back), the position on that radius is used. */
static void distort(const ted4_lens *l, double fold2, double x, double y, double *dx, double *dy)
{
    double u = (x - l->cx) / l->fx, v = (y - l->cy) / l->fy;
    double s = u * u + v * v;

    if (s > fold2) {
        const double shrink = sqrt(fold2 / s);
        u *= shrink;
        v *= shrink;
        s = fold2;
    }
    const double radial = 1 + s * (l->k1 + s * (l->k2 + s * l->k3));
    const double ud = u * radial + 2 * l->p1 * u * v + l->p2 * (s + 2 * u * u);
    const double vd = v * radial + 2 * l->p2 * u * v + l->p1 * (s + 2 * v * v);
    *dx = l->fx * ud + l->skew * vd + l->cx;
    *dy = l->fy * vd + l->cy;
}

static double clamp(double x, double high)
{
    return x > 0 ? (x < high ? x : high) : 0;
}

/* Interpolates at (x, y), in units of samples, with sample 0 at 0. */
static void sample(const uint8_t *in, int width, int height, double x, double y, uint8_t out[3])
{
    x = clamp(x, width - 1);
    y = clamp(y, height - 1);
    const int x0 = (int)x, y0 = (int)y;
    const double ax = x - x0, ay = y - y0;
    const size_t stride = (size_t)width * 3;
    const uint8_t *p = in + (size_t)y0 * stride + (size_t)x0 * 3;
    const size_t right = x0 + 1 < width ? 3 : 0, down = y0 + 1 < height ? stride : 0;

    for (int c = 0; c < 3; c++) {
        const double top = p[c] + ax * (p[right + c] - p[c]);
        const double low = p[down + c] + ax * (p[down + right + c] - p[down + c]);
        out[c] = (uint8_t)(top + ay * (low - top) + 0.5);
    }
}

void ted4_undistort(const ted4_lens *l, const uint8_t *in, uint8_t *out)
{
    const double fold2 = fold_radius2(l);

    for (int y = 0; y < l->height; y++)
        for (int x = 0; x < l->width; x++) {
            double dx, dy;
            distort(l, fold2, x + 0.5, y + 0.5, &dx, &dy);
            sample(in, l->width, l->height, dx - 0.5, dy - 0.5,
                   out + ((size_t)y * (size_t)l->width + (size_t)x) * 3);
        }
}

void ted4_downscale(const uint8_t *in, int width, int height, int n, uint8_t *out)
{
    const int w = width / n, h = height / n;
    const uint32_t area = (uint32_t)n * (uint32_t)n;

    for (int y = 0; y < h; y++)
        for (int x = 0; x < w; x++) {
            uint64_t sum[3] = { 0, 0, 0 };
            for (int j = 0; j < n; j++) {
                const uint8_t *p = in + ((size_t)(y * n + j) * (size_t)width + (size_t)(x * n)) * 3;
                for (int i = 0; i < 3 * n; i += 3) {
                    sum[0] += p[i];
                    sum[1] += p[i + 1];
                    sum[2] += p[i + 2];
                }
            }
            uint8_t *o = out + ((size_t)y * (size_t)w + (size_t)x) * 3;
            for (int c = 0; c < 3; c++)
                o[c] = (uint8_t)((sum[c] + area / 2) / area);
        }
}
