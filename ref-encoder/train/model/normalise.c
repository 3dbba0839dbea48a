/* normalise.c - normalises the scene, its points and its views (normalise.h).
 * SPDX-License-Identifier: BSD-2-Clause */
#include "normalise.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "math/elementary.h"

/* Returns the element that would be at index k if the n numbers were sorted; it reorders them.
 * Every checkpoint needs two such quantiles of all points, and in a snapshot sorting would take
 * most of the time. */
static float pick(float *x, size_t n, size_t k)
{
    size_t low = 0, high = n - 1;

    while (low < high) {
        const float pivot = x[low + (high - low) / 2];
        size_t i = low, j = high;

        for (;; i++, j--) {
            while (x[i] < pivot)
                i++;
            while (x[j] > pivot)
                j--;
            if (i >= j)
                break;

            const float swapped = x[i];

            x[i] = x[j];
            x[j] = swapped;
        }
        if (k <= j)
            high = j;
        else
            low = j + 1;
    }
    return x[k];
}

void ted4_normalise_scene(ted4_header *h, const ted4_dataset *d)
{
    const size_t n = d->n_points;
    float *value = malloc((n + 1) * sizeof *value);

    h->exponent = 0;
    memset(h->origin, 0, sizeof h->origin);
    if (value == NULL || n == 0) {
        free(value);
        return;
    }
    for (int j = 0; j < 3; j++) {
        for (size_t i = 0; i < n; i++)
            value[i] = d->points[3 * i + (size_t)j];
        h->origin[j] = pick(value, n, n / 2);
        if (fabsf(h->origin[j]) < 1e-6f)
            h->origin[j] = 0.0f; /* avoids subnormal numbers and -0 (R-CNV-001) */
    }
    for (size_t i = 0; i < n; i++) {
        float far = 0;

        for (int j = 0; j < 3; j++)
            far = fmaxf(far, fabsf(d->points[3 * i + (size_t)j] - h->origin[j]));
        value[i] = far;
    }

    const double reach = 1.25 * (double)pick(value, n, (size_t)(0.995 * (double)(n - 1)));
    const double e = reach > 0 ? ceil(ted4_math_log2(reach)) : 0;

    h->exponent = (int8_t)(e < -30 ? -30 : e > 30 ? 30 : e);
    free(value);
}

void ted4_normalise_view(const ted4_header *h, const ted4_camera *c, ted4_view *v, float centre[3])
{
    const double unit = ldexp(1.0, -h->exponent);

    v->width = c->width;
    v->height = c->height;
    v->fx = (float)c->fx;
    v->fy = (float)c->fy;
    v->cx = (float)c->cx;
    v->cy = (float)c->cy;
    v->near_z = TED4_NEAR;
    v->pixel = 1.0f;
    for (int j = 0; j < 3; j++)
        v->background[j] = (float)h->background[j] / 255.0f;

    double t[3];

    for (int i = 0; i < 3; i++) {
        t[i] = c->t[i];
        for (int j = 0; j < 3; j++) {
            v->R[3 * i + j] = (float)c->R[3 * i + j];
            t[i] += c->R[3 * i + j] * (double)h->origin[j];
        }
        t[i] *= unit;
        v->t[i] = (float)t[i];
    }
    for (int j = 0; j < 3; j++)
        centre[j] = (float)-(c->R[j] * t[0] + c->R[3 + j] * t[1] + c->R[6 + j] * t[2]);
}

void ted4_normalise_point(const ted4_header *h, const float world[3], float p[3])
{
    for (int j = 0; j < 3; j++)
        p[j] = ldexpf(world[j] - h->origin[j], -h->exponent);
}
