/* ray_texture.h - procedural albedo for the project's scenes. A texture moves with its object.
 * Depends on ray_shape.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef RAY_TEXTURE_H
#define RAY_TEXTURE_H

#include "ray_shape.h"

typedef enum { RAY_FLOOR, RAY_CEILING, RAY_BACK, RAY_FRONT, RAY_LEFT, RAY_RIGHT } ted4_ray_side;

/* Converts a colour given as sRGB in [0, 1] to linear light, by squaring, which is exact enough for
 * a palette. */
static inline vec3 ray_paint(float r, float g, float b)
{
    return v3(r * r, g * g, b * b);
}

/* Returns the linear albedo at material coordinates p of o. */
vec3 ted4_ray_texture(const ted4_ray_object *o, vec3 p, uint32_t seed);

/* Returns the linear albedo of the room's inner surface at world point p. */
vec3 ted4_ray_room_texture(ted4_ray_side side, vec3 p, uint32_t seed);

#endif
