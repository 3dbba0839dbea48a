/* depth_points.h - points on the surfaces that the training pictures show, from depth maps that
 * confirm each other. Depends on depth_map.h, point_cloud.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_DEPTH_POINTS_H
#define TED4_DEPTH_POINTS_H

#include "data/depth_map.h"
#include "data/point_cloud.h"

/* Most depth maps of a scene: those of all pictures of a few evenly spaced frames. */
enum { TED4_DEPTH_MAPS = 32 };

typedef struct {
    size_t most; /* number of points at most */
    uint32_t seed;
    /* Returns whether a point, in world coordinates, is wanted. Called on the calling thread. */
    int (*keep)(const void *user, const float xyz[3]);
    const void *user;
} ted4_depth_wanted;

/* Fills *c with the wanted points, drawn at random from the cells of depth maps whose depth at
 * least half of the other maps that see the place confirm; a map that shows something nearer does
 * not see it. Depths are means over these maps. *c is empty if no two maps agree. Working memory is
 * at most TED4_DEPTH_CELLS * (4 * TED4_DEPTH_PLANES + 64) bytes for each thread, and
 * TED4_DEPTH_CELLS * 45 bytes for each of TED4_SHOWN_MOST pictures. The result depends only on the
 * pictures and on *o. Returns 0, or -1 if memory ran out; the caller frees *c in either case. */
int ted4_depth_points(ted4_point_cloud *c, const ted4_sweep *w, const ted4_depth_wanted *o,
                      const ted4_parallel *p);

#endif
