/* ray_shot.h - the pixels of one picture of a scene, and the mask of its moving parts. Depends on
 * ray_rig.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef RAY_SHOT_H
#define RAY_SHOT_H

#include "ray_rig.h"

/* Renders rgba [height][width][4] as the file stores it: over the background or, if that is
 * transparent, with alpha, straight or premultiplied. */
void ted4_ray_shot(const ted4_ray_options *o, int number, int frame, uint8_t *rgba);

/* Makes mask [height][width]: 255 where the picture differs, by 8 of 255 or more in a channel, from
 * the picture without the solids that change over time, which is where they or their shadows are
 * seen; else 0. Returns 0, or -1 without memory. */
int ted4_ray_mask(const ted4_ray_options *o, int number, int frame, uint8_t *mask);

#endif
