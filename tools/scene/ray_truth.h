/* ray_truth.h - truth.json, what is out of the ordinary in a scene: held-out times, errors, tints,
 * lamp.
 * Depends on ray_layout.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef RAY_TRUTH_H
#define RAY_TRUTH_H

#include "ray_layout.h"

/* Is there anything to say? Of the first scenes with their defaults there is not. */
int ted4_ray_has_truth(const ted4_ray_options *o);

/* Writes it. Members: what the scene is; held_times (indices); world (coordinates of the files =
 * scale times those of the room + shift, and turned about x where up is y); turned_away (training
 * cameras that see nothing but background); lamp (power at each time, steady: 1) and solids (how
 * many at each time); cameras, in the order of the files: true and stated (camera to world, both in
 * coordinates of the files), colour (3 x 3 rows, linear light to what the camera takes it for). */
ted4_ray_put ted4_ray_put_truth;

#endif
