/* camera_view.h - the camera of a dataset's picture as a view that is rendered.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_CAMERA_VIEW_H
#define TED4_CAMERA_VIEW_H

#include "data/dataset.h"
#include "render/raster.h"

/* near_z and background are 0: ted4_render_query sets them. */
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

#endif
