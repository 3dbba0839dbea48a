/* sweep_depths.c - see sweep_depths.h. A lane stands for a depth.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "sweep_depths.h"

#include <math.h>
#include <string.h>

#include "error_view.h"
#include "photo_votes.h"
#include "train/math/lane_math.h"
#include "view_geometry.h"

/* Computes the points of all lanes. on: -1 where the depth is to be judged, else 0. Returns whether
 * there is such a lane. */
static inline int place(const ted4_sweep_ray *r, int first, ted4_swept_depths *d, int32_t *on)
{
    const ted4_sweep_view *own = &r->views[r->self];
    const ted4_view view = own->view;
    const float nearest = own->nearest, farthest = own->farthest;
    const int depths = own->depths;
    const float last = (float)(depths - 1);
    int32_t any = 0;

#pragma omp simd reduction(| : any)
    for (int j = 0; j < TED4_DEPTHS; j++) {
        const float part = (float)(first + j) / last;
        const float z = 1.0f / ((1.0f - part) / nearest + part / farthest);
        float p[3];

        ted4_ray_point(&view, r->ray, z, p);
        d->z[j] = z;
        d->p[0][j] = p[0];
        d->p[1][j] = p[1];
        d->p[2][j] = p[2];
        on[j] = -((first + j < depths) & (fabsf(p[0]) <= 1.0f) & (fabsf(p[1]) <= 1.0f) &
                  (fabsf(p[2]) <= 1.0f));
        any |= on[j];
    }
    return any;
}

/* Returns ted4_colour_far of packed pixels. */
static inline int32_t far_apart(uint32_t a, uint32_t b)
{
    return ted4_channels_far((int)(a & 255) - (int)(b & 255),
                             (int)(a >> 8 & 255) - (int)(b >> 8 & 255),
                             (int)(a >> 16 & 255) - (int)(b >> 16 & 255));
}

/* Adds what another picture says. */
static inline void confirm(const ted4_sweep_view *other, uint32_t own, const int32_t *on,
                           ted4_swept_depths *d)
{
    const ted4_view view = other->view;
    const uint32_t *const pixel = other->pixel;
    const float right = (float)(view.width - 1), bottom = (float)(view.height - 1);

#pragma omp simd
    for (int j = 0; j < TED4_DEPTHS; j++) {
        float x, y;
        const float z = ted4_view_project(&view, d->p[0][j], d->p[1][j], d->p[2][j], &x, &y);
        const int32_t seen = on[j] & -ted4_view_holds(&view, x, y, z);
        const int32_t column = (int32_t)ted4_lane_within(x, 0.0f, right),
                      row = (int32_t)ted4_lane_within(y, 0.0f, bottom);
        const uint32_t there = pixel[row * view.width + column];
        const int32_t apart = far_apart(there, own);
        const int32_t agrees = seen & -((int32_t)(there >> 24) >= TED4_MISSING / 2) &
                               -(apart < 3 * TED4_COLOUR_NEAR);
        const float score = 1.0f - (float)apart / (3.0f * TED4_COLOUR_NEAR + 1.0f);

        d->seen[j] -= seen;
        d->agree[j] -= agrees;
        d->score[j] += ted4_lane_keep(agrees, score);
    }
}

void TED4_LEVELED(ted4_sweep_depths)(const ted4_sweep_ray *r, int first, ted4_swept_depths *d)
{
    int32_t on[TED4_DEPTHS];

    memset(d, 0, sizeof *d);
    if (!place(r, first, d, on))
        return;
    for (size_t i = 0; i < r->n; i++)
        if (i != r->self)
            confirm(&r->views[i], r->pixel, on, d);
}
