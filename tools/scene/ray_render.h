/* ray_render.h - renders pictures of a world, and finds points on its surfaces. Depends on
 * ray_world.h, ray_camera.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef RAY_RENDER_H
#define RAY_RENDER_H

#include "ray_camera.h"
#include "ray_world.h"

/* Renders to rgb [height][width][3] in sRGB bytes, with 3 x 3 samples per pixel. */
void ted4_ray_render(const ted4_ray_world *w, const ted4_ray_camera *c, uint8_t *rgb);

/* Renders the things alone to rgba [height][width][4]; alpha is the share of the pixel that they
 * cover, and colours are black where it is 0. */
void ted4_ray_cut_out(const ted4_ray_world *w, const ted4_ray_camera *c, uint8_t *rgba);

/* What a camera sees at pixel coordinates (px, py). */
typedef struct {
    vec3 point;
    float depth; /* along the ray; infinite if it meets nothing */
    int object;  /* index in the world; -1: the room; -2: nothing, with black colour and no point */
    vec3 colour; /* linear light, without the camera's colour matrix */
} ted4_ray_sight;

ted4_ray_sight ted4_ray_look(const ted4_ray_world *w, const ted4_ray_camera *c, double px,
                             double py);

#endif
