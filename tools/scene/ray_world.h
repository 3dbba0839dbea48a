/* ray_world.h - the scenes: which solids exist at a time, and where. Depends on ray_shape.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef RAY_WORLD_H
#define RAY_WORLD_H

#include "ray_shape.h"

enum { TED4_RAY_MAX_OBJECTS = 40 };

/* The scenes up to RAY_FAIR demonstrate the codec. They are followed by scenes in which methods
 * fail, and by scenes that show how file size depends on content. ray_scene.c describes each scene.
 */
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
    RAY_DUSK,
    RAY_TINTS4,
    RAY_THINGS0,
    RAY_THINGS1,
    RAY_THINGS2,
    RAY_THINGS4,
    RAY_THINGS8,
    RAY_REST,
    RAY_TOYS,
    RAY_RELAY,
    RAY_SCENES
} ted4_ray_scene;

/* The surroundings of the solids: a room with patterns on all surfaces that cameras see; the same
 * room with walls of one colour; or nothing, in black. */
typedef enum { RAY_PAPERED, RAY_PLAIN, RAY_DARK } ted4_ray_room;

/* World axes: x is right, y points away from the cameras, z is up. The room is a box seen from
 * inside. */
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

/* Makes a room and a lamp without objects. Add objects with ted4_ray_add. */
void ted4_ray_world_empty(ted4_ray_world *w, uint32_t seed);

/* Returns a copy of o with its bounds set, or NULL if the world is full. */
ted4_ray_object *ted4_ray_add(ted4_ray_world *w, const ted4_ray_object *o);

/* Parts of scenes. turn: the row-major rotation about a world axis (0 x, 1 y, 2 z). solid: a solid
 * turned about z, with its texture and colours. */
void ted4_ray_turn(float m[9], int axis, double turns);
ted4_ray_object ted4_ray_solid(ted4_ray_kind kind, vec3 size, vec3 pos, double turns);
void ted4_ray_dress(ted4_ray_object *o, ted4_ray_texture_kind texture, vec3 a, vec3 b, vec3 c);

/* Adds a painted box with a ball on an arm, which all turn together on a drum: four solids. */
void ted4_ray_carousel(ted4_ray_world *w, double turns);

/* Returns the time of a frame, which is 0 if there is only one frame. */
double ted4_ray_time(int frame, int n_frames);

/* ---- ray_world.c ---- */

/* Makes the scene at frame j of n, at time j / (n - 1). */
void ted4_ray_world_at(ted4_ray_world *w, ted4_ray_scene s, uint32_t seed, int frame, int n_frames);

#endif
