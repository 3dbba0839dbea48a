/* ray_scene.h - the names of the scenes, what each shows, and its default options. Depends on
 * ray_ways.h, ray_world.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef RAY_SCENE_H
#define RAY_SCENE_H

#include "ray_ways.h"
#include "ray_world.h"

typedef struct {
    const char *name;  /* "still", "turn", ... */
    const char *shows; /* description of one line */
    int width, height;
    int n_train, n_test; /* numbers of cameras */
    int n_frames;        /* number of times */
    int hold;            /* training cameras have no picture of the middle time of every so many
                            (ted4_ray_is_held); 0: all pictures exist */
    double pose_error;   /* degrees, see ray_rig.h */
    double tint;         /* strength, see ray_rig.h */
    double drift;        /* stops, see ray_rig.h */
    int places; /* number of places on the arc, of which the training cameras take the middle ones;
                   0: one per camera */
    int turned_away; /* the last of several training cameras looks away from the scene */
    ted4_ray_background background; /* surroundings of the things, by default */
    int same;   /* 1: the test cameras are the training cameras again, which take the held-out times
                   (layouts with lists only) */
    int rounds; /* 1: cameras take turns, in rounds in which each takes one picture
                   (ted4_ray_is_taken) */
    int dome;   /* cameras stand around the things on all sides, unless these are in a room */
    double scale,
        shift[3]; /* coordinates in the files = scale times coordinates in the room + shift */
} ted4_ray_plan;

/* s must be below RAY_SCENES. */
const ted4_ray_plan *ted4_ray_plan_of(ted4_ray_scene s);
const char *ted4_ray_scene_name(ted4_ray_scene s);

#endif
