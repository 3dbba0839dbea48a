/* ray_shot.h - the pixels of one picture of a scene, and where it shows what moves.
 * Depends on ray_rig.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef RAY_SHOT_H
#define RAY_SHOT_H

#include "ray_rig.h"

/* rgba [height][width][4] as the file holds it: on the background; with alpha, straight or
 * multiplied, where that is transparent. */
void ted4_ray_shot(const ted4_ray_options *o, int number, int frame, uint8_t *rgba);

/* mask [height][width]: 255 where the picture is another without the solids that are not the same
 * at all times (so where these are seen, or their shadows), by 8 of 255 or more in a channel; else
 * 0. 0, or -1: no memory. */
int ted4_ray_mask(const ted4_ray_options *o, int number, int frame, uint8_t *mask);

#endif
