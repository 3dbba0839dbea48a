/* ray_scene.h - names of the scenes, what each shows, and the defaults that belong to it.
 * Depends on ray_ways.h, ray_world.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef RAY_SCENE_H
#define RAY_SCENE_H

#include "ray_ways.h"
#include "ray_world.h"

typedef struct {
    const char *name;  /* "still", "turn", ... */
    const char *shows; /* one line */
    int width, height;
    int n_train, n_test; /* cameras */
    int n_frames;        /* times */
    int hold; /* training cameras lack the middle one of each so many times (ted4_ray_is_held); 0:
                 none */
    double pose_error; /* degrees, see ray_rig.h */
    double tint;       /* strength, see ray_rig.h */
    int places; /* on the arc, of which the training cameras take the middle ones; 0: as many as
                   cameras */
    int turned_away; /* the last of several training cameras looks away from the scene */
    ted4_ray_background background; /* what is around the things, unless said */
    int dome;               /* cameras stand all about the things, unless these are in a room */
    double scale, shift[3]; /* coordinates in the files = scale times those of the room + shift */
} ted4_ray_plan;

/* Of a scene before RAY_SCENES. */
const ted4_ray_plan *ted4_ray_plan_of(ted4_ray_scene s);
const char *ted4_ray_scene_name(ted4_ray_scene s);

#endif
