/* ray_truth.h - truth.json, which lists what is special about a scene: held-out times, errors,
 * tints, the lamp. Depends on ray_layout.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef RAY_TRUTH_H
#define RAY_TRUTH_H

#include "ray_layout.h"

/* Returns 1 if there is anything to report. The first scenes with their default options have
 * nothing. */
int ted4_ray_has_truth(const ted4_ray_options *o);

/* Writes truth.json. Members: what the scene is; held_times (indices); world (coordinates of the
 * files = scale times those of the room + shift, turned about x if up is y); turned_away (training
 * cameras that see nothing but background); lamp (power at each time; steady: 1) and solids (their
 * number at each time); cameras, in the order of the files: true and stated (camera to world, both
 * in the coordinates of the files), colour (3 x 3 rows, linear light to the camera's colours), and
 * exposure (at each time, a factor of colour).
 */
ted4_ray_put ted4_ray_put_truth;

#endif
