/* ray_render.h - pictures of a world, and points on its surfaces.
 * Depends on ray_world.h, ray_camera.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef RAY_RENDER_H
#define RAY_RENDER_H

#include "ray_camera.h"
#include "ray_world.h"

/* rgb [height][width][3] sRGB bytes; 3 x 3 samples a pixel. */
void ted4_ray_render(const ted4_ray_world *w, const ted4_ray_camera *c, uint8_t *rgb);

/* rgba [height][width][4]: the same of what is seen of things alone, and how much of the pixel they
 * cover; black where that is nothing. */
void ted4_ray_cut_out(const ted4_ray_world *w, const ted4_ray_camera *c, uint8_t *rgba);

/* What a camera sees through pixel coordinates (px, py). */
typedef struct {
    vec3 point;
    float depth; /* along the ray; infinite where nothing is */
    int object;  /* index in the world, -1: the room, -2: nothing, colour black, no point */
    vec3 colour; /* linear, lit; what the camera makes of it is left out */
} ted4_ray_sight;

ted4_ray_sight ted4_ray_look(const ted4_ray_world *w, const ted4_ray_camera *c, double px,
                             double py);

#endif
