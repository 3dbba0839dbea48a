/* camera_path.h - cameras that move: along key cameras, and around a point.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_CAMERA_PATH_H
#define TED4_CAMERA_PATH_H

#include <stddef.h>

#include "camera_list.h"

/* Fills view[n] with cameras from the first key to the last one, evenly by keys. Centres follow a
 * Catmull-Rom spline, rotations go the shortest way (slerp), lenses change linearly; the size is
 * that of the first key. n >= 1; keys->n >= 1. */
void ted4_path_between(const ted4_camera_list *keys, size_t n, ted4_view *view);

/* Returns where picture i of n of ted4_path_between lies: from 0 at the first key to keys - 1. */
double ted4_path_position(size_t i, size_t n, size_t keys);

typedef struct {
    double centre[3]; /* the point that is looked at, in world coordinates */
    double up[3];     /* unit vector */
    double start[3];  /* direction from centre to the first camera; any length */
    double swing;     /* largest angle from start, radians; 0: all the way around */
    double radius;    /* from the axis through centre along up to the cameras, world units; > 0 */
    double height;    /* of the cameras above centre, along up */
    ted4_view lens;   /* size, focal lengths and principal point */
} ted4_orbit;

/* Fills view[n] with cameras on a circle, all looking at the centre: evenly around it, or to and
 * fro on both sides of the start. */
void ted4_orbit_around(const ted4_orbit *o, size_t n, ted4_view *view);

/* Sets start, swing, radius and height to the means of cameras around o->centre and o->up. Cameras
 * that stand around the centre give no swing. */
void ted4_orbit_of_cameras(const ted4_camera_list *l, ted4_orbit *o);

/* Finds the point that cameras look at: the one nearest to all their optical axes. Returns 0, or -1
 * if the axes are nearly parallel, or the point is behind half of the cameras. */
int ted4_orbit_pivot(const ted4_camera_list *l, double centre[3]);

/* The centre of a view: -R^T t. */
void ted4_view_centre(const ted4_view *v, double centre[3]);

#endif
