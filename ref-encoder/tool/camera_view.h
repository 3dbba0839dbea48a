/* camera_view.h - the camera of a dataset's picture, as a view that is rendered, and in a file's
 * scene.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_CAMERA_VIEW_H
#define TED4_CAMERA_VIEW_H

#include <math.h>

#include "data/dataset.h"
#include "render/raster.h"
#include "ted4.h"

/* near_z, background and pixel are 0: ted4_render_query sets the first two. */
static inline ted4_view ted4_view_of_camera(const ted4_camera *c)
{
    ted4_view v = { .width = c->width,
                    .height = c->height,
                    .fx = (float)c->fx,
                    .fy = (float)c->fy,
                    .cx = (float)c->cx,
                    .cy = (float)c->cy };

    for (int i = 0; i < 9; i++)
        v.R[i] = (float)c->R[i];
    for (int i = 0; i < 3; i++)
        v.t[i] = (float)c->t[i];
    return v;
}

/* Returns how far the middle of the file's scene is from a camera, but at least its size. */
static inline double ted4_distance_to(const ted4_info *info, const ted4_camera *c)
{
    double square = 0;

    for (int i = 0; i < 3; i++) {
        double x = c->t[i];

        for (int j = 0; j < 3; j++)
            x += c->R[3 * i + j] * (double)info->origin[j];
        square += x * x;
    }
    return fmax(sqrt(square), ldexp(1.0, info->exponent));
}

#endif
