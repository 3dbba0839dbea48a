/* ray_world.h - the scenes: which solids are where at a time.
 * Depends on ray_shape.h. Used by ray_render, ray_set and the test.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef RAY_WORLD_H
#define RAY_WORLD_H

#include "ray_shape.h"

enum { TED4_RAY_MAX_OBJECTS = 16 };

typedef enum { RAY_STILL, RAY_TURN, RAY_OCCLUDER, RAY_POP, RAY_BEND, RAY_FAIR, RAY_SCENES } ted4_ray_scene;

/* World axes: x right, y away from the cameras, z up. The room is a box seen from inside. */
typedef struct {
    vec3 room_low, room_high;
    vec3 lamp, lamp_x, lamp_y;          /* centre and half edges of the area light */
    ted4_ray_object object[TED4_RAY_MAX_OBJECTS];
    int      n;
    uint32_t seed;
} ted4_ray_world;

/* "still", "turn", ... */
const char *ted4_ray_scene_name(ted4_ray_scene s);

/* Room and lamp without objects; add objects with ted4_ray_add. */
void ted4_ray_world_empty(ted4_ray_world *w, uint32_t seed);

/* A copy of o with its bounds made, or NULL when the world is full. */
ted4_ray_object *ted4_ray_add(ted4_ray_world *w, const ted4_ray_object *o);

/* The scene at frame j of n; time j / (n - 1). */
void ted4_ray_world_at(ted4_ray_world *w, ted4_ray_scene s, uint32_t seed, int frame, int n_frames);

/* Time of a frame, 0 when there is one frame only. */
double ted4_ray_time(int frame, int n_frames);

#endif
