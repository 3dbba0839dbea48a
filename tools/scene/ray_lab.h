/* ray_lab.h - what happens in the scenes in which methods fail, and in those for file sizes.
 * Depends on ray_world.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef RAY_LAB_H
#define RAY_LAB_H

#include "ray_world.h"

/* Adds to a furnished world what scene s, one after RAY_FAIR, has at a frame; may change room, lamp
 * and furniture. */
void ted4_ray_lab_at(ted4_ray_world *w, ted4_ray_scene s, int frame, int n_frames);

/* Power of the flickering lamp at a frame in shares of a steady one; below 0.4 and above 1 in
 * turn. */
float ted4_ray_flicker(int frame, uint32_t seed);

/* ray_things.c: eight things in the middle of the room, the first n_moving of which have moved for
 * the time of that many frames; a second has 16. */
void ted4_ray_things(ted4_ray_world *w, int n_moving, int frames);

/* ray_toys.c: a few small things on a disk, of which a ball goes round and four droplets fall; no
 * furniture. */
void ted4_ray_toys(ted4_ray_world *w, double t);

#endif
