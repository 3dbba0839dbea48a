/* raster_scene.h - random Gaussians and views for test_raster.c, test_raster_grad.c and
 * bench/bench_raster.c.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_RASTER_SCENE_H
#define TED4_RASTER_SCENE_H

#include <math.h>
#include <stdint.h>
#include <stdlib.h>

#include "data/data_util.h"
#include "render/raster.h"

/* Parameters of a Gaussian in the order of ted4_splats: mean 3, scale 3, rotation 4, opacity,
 * colour 3. */
enum {
    SCENE_PARAMS = 14,
    SCENE_MEAN = 0,
    SCENE_SCALE = 3,
    SCENE_ROT = 6,
    SCENE_OPACITY = 10,
    SCENE_COLOUR = 11
};

typedef struct {
    size_t n;
    float *value; /* [SCENE_PARAMS][n] */
} scene;

static inline double scene_range(uint64_t *seed, double lo, double hi)
{
    return lo + (hi - lo) * ted4_split_uniform(seed);
}

static inline double scene_normal(uint64_t *seed)
{
    const double u = 1 - ted4_split_uniform(seed);

    return sqrt(-2 * log(u)) * cos(6.283185307179586 * ted4_split_uniform(seed));
}

static inline float *scene_param(const scene *s, int param, size_t i)
{
    return &s->value[(size_t)param * s->n + i];
}

static inline ted4_splats scene_splats(const scene *s)
{
    ted4_splats g = { .n = s->n, .opacity = scene_param(s, SCENE_OPACITY, 0) };

    for (int k = 0; k < 3; k++) {
        g.mean[k] = scene_param(s, SCENE_MEAN + k, 0);
        g.scale[k] = scene_param(s, SCENE_SCALE + k, 0);
        g.colour[k] = scene_param(s, SCENE_COLOUR + k, 0);
    }
    for (int k = 0; k < 4; k++)
        g.rot[k] = scene_param(s, SCENE_ROT + k, 0);
    return g;
}

static inline void scene_rotation(const scene *s, size_t i, double w, double x, double y, double z)
{
    const double q[4] = { w, x, y, z }, norm = sqrt(w * w + x * x + y * y + z * z);

    for (int k = 0; k < 4; k++)
        *scene_param(s, SCENE_ROT + k, i) = (float)(q[k] / norm);
}

/* A view almost along +z, with an off-centre principal point and unequal focal lengths. */
static inline ted4_view scene_view(int width, int height)
{
    const double a = 0.1, c = cos(a), s = sin(a);

    return (ted4_view) {
        .width = width,
        .height = height,
        .fx = 0.9f * (float)width,
        .fy = 1.0f * (float)width,
        .cx = 0.47f * (float)width,
        .cy = 0.55f * (float)height,
        .R = { (float)c, 0, (float)-s, 0, 1, 0, (float)s, 0, (float)c },
        .t = { 0.2f, -0.1f, 0.3f },
        .near_z = 0.2f,
        .background = { 0.1f, 0.5f, 0.9f },
    };
}

/* Places Gaussian i at the world point that v sees at pixel (x, y) and depth z. */
static inline void scene_place(const scene *s, const ted4_view *v, size_t i, double x, double y,
                               double z)
{
    const double c[3] = { (x - v->cx) / v->fx * z - v->t[0], (y - v->cy) / v->fy * z - v->t[1],
                          z - v->t[2] };

    for (int k = 0; k < 3; k++)
        *scene_param(s, SCENE_MEAN + k, i) =
            (float)(v->R[k] * c[0] + v->R[3 + k] * c[1] + v->R[6 + k] * c[2]);
}

/* Makes n Gaussians spread over the image and slightly beyond it, at depths 1 to 8, with a standard
 * deviation of about sigma pixels. Free with scene_free. */
static inline scene scene_random(size_t n, const ted4_view *v, double sigma, uint64_t seed)
{
    scene s = { n, malloc((n * SCENE_PARAMS + 1) * sizeof(float)) };

    for (size_t i = 0; i < n && s.value != NULL; i++) {
        const double z = scene_range(&seed, 1, 8);

        const double y = scene_range(&seed, -0.1, 1.1) * v->height;

        scene_place(&s, v, i, scene_range(&seed, -0.1, 1.1) * v->width, y, z);
        for (int k = 0; k < 3; k++) {
            *scene_param(&s, SCENE_SCALE + k, i) =
                (float)(z / v->fx * sigma * exp(0.6 * scene_normal(&seed)));
            *scene_param(&s, SCENE_COLOUR + k, i) = (float)ted4_split_uniform(&seed);
        }
        double q[4];

        for (int k = 3; k >= 0; k--)
            q[k] = scene_normal(&seed);
        scene_rotation(&s, i, q[0], q[1], q[2], q[3]);
        *scene_param(&s, SCENE_OPACITY, i) = (float)(1 / (1 + exp(-1.8 * scene_normal(&seed))));
    }
    return s;
}

static inline void scene_free(scene *s)
{
    free(s->value);
    s->value = NULL;
}

#endif
