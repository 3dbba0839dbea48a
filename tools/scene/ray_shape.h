/* ray_shape.h - the solids of the project's scenes: their intersections with rays, and their
 * surfaces. Depends on ray_math.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef RAY_SHAPE_H
#define RAY_SHAPE_H

#include "ray_math.h"

/* Local shapes, centred on the origin unless stated otherwise:
 *   sphere    radius size.x
 *   box       half edges size
 *   cylinder  radius size.x, half height size.z, axis z, capped
 *   bar       half section size.x by size.y, from z = 0 to size.z. It is first twisted about z
 *             (twist turns per unit length, in all less than a quarter turn) and then bent in the
 *             xz plane to an arc (bend radians per unit length, towards +x) */
typedef enum { RAY_SPHERE, RAY_BOX, RAY_CYLINDER, RAY_BAR } ted4_ray_kind;

typedef enum {
    RAY_FLAT,
    RAY_WOOD,
    RAY_MARBLE,
    RAY_CHECKER,
    RAY_SPIRAL,
    RAY_DOTS,
    RAY_FACES,
    RAY_BEACH,
    RAY_RIBBON,
    RAY_BRICK
} ted4_ray_texture_kind;

typedef struct {
    ted4_ray_kind kind;
    vec3 size;
    float rot[9]; /* row-major: x_world = rot x_local + pos */
    vec3 pos;
    float bend, twist; /* for a bar only */
    ted4_ray_texture_kind texture;
    vec3 skin;      /* added to material coordinates, so that pieces of one thing share a pattern */
    vec3 colour[3]; /* linear light */
    float gloss;    /* weight of the specular highlight */
    vec3 low, high; /* for a bar only: local bounding box; set by ted4_ray_bound */
    vec3 centre;    /* bounding sphere in world axes; set by ted4_ray_bound */
    float reach;
} ted4_ray_object;

typedef struct {
    vec3 normal;   /* in world coordinates, of unit length, outwards */
    vec3 material; /* coordinates fixed to the object, for textures */
} ted4_ray_surface;

/* Sets the bounds of o. Call this after the last change of its other members. */
void ted4_ray_bound(ted4_ray_object *o);

/* Returns the smallest t in (near, far) for which from + t d lies on the surface, or far if there
 * is none. d has unit length. */
float ted4_ray_meet(const ted4_ray_object *o, vec3 from, vec3 d, float near, float far);

/* Returns the surface at a point of it, in world coordinates. */
ted4_ray_surface ted4_ray_surface_at(const ted4_ray_object *o, vec3 point);

/* For a bar: convert a local point to coordinates of the straight, untwisted bar, and back. */
vec3 ted4_ray_unbend(const ted4_ray_object *o, vec3 local);
vec3 ted4_ray_rebend(const ted4_ray_object *o, vec3 straight);

#endif
