/* ray_world.h - the scenes: which solids are where at a time.
 * Depends on ray_shape.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef RAY_WORLD_H
#define RAY_WORLD_H

#include "ray_shape.h"

enum { TED4_RAY_MAX_OBJECTS = 40 };

/* Up to RAY_FAIR: the scenes that everything is shown with. Then those in which methods fail, and
 * those that tell how file size follows content; what is in each: ray_scene.c. */
typedef enum {
    RAY_STILL,
    RAY_TURN,
    RAY_OCCLUDER,
    RAY_POP,
    RAY_BEND,
    RAY_FAIR,
    RAY_HIDE,
    RAY_BLINK,
    RAY_FAST,
    RAY_SPLIT,
    RAY_TINTS,
    RAY_FLICKER,
    RAY_BARE,
    RAY_FAR,
    RAY_WIDE,
    RAY_PAIR,
    RAY_LONG,
    RAY_WIRES,
    RAY_SHAKEN,
    RAY_CHANGE,
    RAY_EMPTY,
    RAY_MOMENT,
    RAY_ALONE,
    RAY_EDGE,
    RAY_THINGS0,
    RAY_THINGS1,
    RAY_THINGS2,
    RAY_THINGS4,
    RAY_THINGS8,
    RAY_REST,
    RAY_TOYS,
    RAY_SCENES
} ted4_ray_scene;

/* What is around the solids: a room with patterns on all that cameras see; the same with walls of
 * one colour; nothing, black. */
typedef enum { RAY_PAPERED, RAY_PLAIN, RAY_DARK } ted4_ray_room;

/* World axes: x right, y away from the cameras, z up. The room is a box seen from inside. */
typedef struct {
    ted4_ray_room room;
    vec3 room_low, room_high;
    vec3 lamp, lamp_x, lamp_y; /* centre and half edges of the area light */
    float lamp_power;
    ted4_ray_object object[TED4_RAY_MAX_OBJECTS];
    int n;
    uint32_t seed;
} ted4_ray_world;

/* ---- ray_parts.c ---- */

/* Room and lamp without objects; add objects with ted4_ray_add. */
void ted4_ray_world_empty(ted4_ray_world *w, uint32_t seed);

/* A copy of o with its bounds made, or NULL when the world is full. */
ted4_ray_object *ted4_ray_add(ted4_ray_world *w, const ted4_ray_object *o);

/* Parts for scenes. The row-major rotation about a world axis (0 x, 1 y, 2 z); a solid turned about
 * z; its texture and colours. */
void ted4_ray_turn(float m[9], int axis, double turns);
ted4_ray_object ted4_ray_solid(ted4_ray_kind kind, vec3 size, vec3 pos, double turns);
void ted4_ray_dress(ted4_ray_object *o, ted4_ray_texture_kind texture, vec3 a, vec3 b, vec3 c);

/* A painted box with a ball on an arm, all turning together on a drum: four solids. */
void ted4_ray_carousel(ted4_ray_world *w, double turns);

/* Time of a frame, 0 when there is one frame only. */
double ted4_ray_time(int frame, int n_frames);

/* ---- ray_world.c ---- */

/* The scene at frame j of n; time j / (n - 1). */
void ted4_ray_world_at(ted4_ray_world *w, ted4_ray_scene s, uint32_t seed, int frame, int n_frames);

#endif
