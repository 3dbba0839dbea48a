/* ray_lab.h - the events of the scenes in which methods fail, and of those for file sizes. Depends
 * on ray_world.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef RAY_LAB_H
#define RAY_LAB_H

#include "ray_world.h"

/* Adds to a furnished world the content of scene s, a scene after RAY_FAIR, at a frame. May change
 * the room, the lamp and the furniture. */
void ted4_ray_lab_at(ted4_ray_world *w, ted4_ray_scene s, int frame, int n_frames);

/* Returns the power of the flickering lamp at a frame, relative to a steady one; it alternates
 * between values below 0.4 and above 1. */
float ted4_ray_flicker(int frame, uint32_t seed);

/* ray_things.c: adds eight things to the middle of the room. The first n_moving of them have moved
 * for the duration of that many frames, at 16 frames per second. */
void ted4_ray_things(ted4_ray_world *w, int n_moving, int frames);

/* ray_toys.c: adds a few small things on a disk, without furniture: a ball goes round, and four
 * droplets fall. */
void ted4_ray_toys(ted4_ray_world *w, double t);

/* ray_relay.c: adds a disk with two things that stand still, without furniture; a ball goes round,
 * a block swings on a rod, and drops fall past the disk. Only the drops depend on the number of
 * frames. */
void ted4_ray_relay(ted4_ray_world *w, double t, int frame);

#endif
