/* ray_world.c - the furniture common to all scenes, and what moves in each.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "ray_world.h"

#include "ray_lab.h"
#include "ray_texture.h"

/* Objects that are in every scene and never move. */
static void furniture(ted4_ray_world *w)
{
    const vec3 cream = ray_paint(.95f, .90f, .80f), ink = ray_paint(.16f, .18f, .24f);
    ted4_ray_object o =
        ted4_ray_solid(RAY_CYLINDER, v3(.26f, .26f, .85f), v3(-1.55f, 1.3f, .85f), 0);

    ted4_ray_dress(&o, RAY_SPIRAL, ray_paint(.90f, .86f, .78f), ray_paint(.22f, .46f, .50f),
                   ray_paint(.80f, .50f, .20f));
    ted4_ray_add(w, &o);

    o = ted4_ray_solid(RAY_BOX, v3(.42f, .42f, .36f), v3(1.55f, 1.15f, .36f), 0.06);
    ted4_ray_dress(&o, RAY_WOOD, ray_paint(.86f, .66f, .42f), ray_paint(.50f, .30f, .18f), ink);
    ted4_ray_add(w, &o);

    o = ted4_ray_solid(RAY_SPHERE, v3(.32f, .32f, .32f), v3(1.52f, 1.13f, 1.04f), 0);
    ted4_ray_dress(&o, RAY_MARBLE, ray_paint(.30f, .52f, .38f), ray_paint(.90f, .94f, .86f), ink);
    o.gloss = 0.25f;
    ted4_ray_add(w, &o);

    o = ted4_ray_solid(RAY_SPHERE, v3(.27f, .27f, .27f), v3(-1.35f, -.55f, .27f), 0);
    ted4_ray_dress(&o, RAY_DOTS, cream, ray_paint(.82f, .20f, .22f), ray_paint(.14f, .30f, .62f));
    o.gloss = 0.2f;
    ted4_ray_add(w, &o);

    o = ted4_ray_solid(RAY_CYLINDER, v3(.31f, .31f, .19f), v3(1.25f, -.62f, .19f), 0.1);
    ted4_ray_dress(&o, RAY_CHECKER, cream, ray_paint(.62f, .16f, .30f), ink);
    ted4_ray_add(w, &o);

    o = ted4_ray_solid(RAY_BOX, v3(.15f, .15f, .15f), v3(1.22f, -.64f, .53f), 0.09);
    ted4_ray_dress(&o, RAY_FACES, cream, cream, cream);
    ted4_ray_add(w, &o);
}

/* A ball rolls to the right behind a wall and returns. */
static void occluder(ted4_ray_world *w, double t)
{
    const float r = 0.36f, x = -1.28f * (float)ted4_ray_cos(0.94 * t);
    ted4_ray_object o = ted4_ray_solid(RAY_BOX, v3(.52f, .09f, .56f), v3(0, -.35f, .56f), 0.01);

    ted4_ray_dress(&o, RAY_BRICK, ray_paint(.44f, .52f, .60f), ray_paint(.68f, .72f, .76f),
                   ray_paint(.90f, .88f, .82f));
    ted4_ray_add(w, &o);

    o = ted4_ray_solid(RAY_SPHERE, v3(r, r, r), v3(x, .45f, r), 0);
    ted4_ray_turn(o.rot, 1, (double)(x / r) / (2 * RAY_PI));
    ted4_ray_dress(&o, RAY_BEACH, ray_paint(.96f, .93f, .86f), ray_paint(.88f, .28f, .22f),
                   ray_paint(.18f, .36f, .68f));
    o.gloss = 0.2f;
    ted4_ray_add(w, &o);
}

/* A ball is present only from 5/16 to 11/16 of the sequence, a box in the first half, and a column
 * from one quarter on. */
static void pop(ted4_ray_world *w, int frame, int n_frames)
{
    const vec3 cream = ray_paint(.95f, .91f, .82f), ink = ray_paint(.15f, .16f, .22f);
    const int part = 16 * frame / n_frames;
    ted4_ray_object o = ted4_ray_solid(RAY_SPHERE, v3(.42f, .42f, .42f), v3(.05f, -.3f, .42f), 0.1);

    ted4_ray_dress(&o, RAY_DOTS, ray_paint(.96f, .76f, .22f), ray_paint(.14f, .40f, .36f),
                   ray_paint(.80f, .22f, .30f));
    o.gloss = 0.2f;
    if (part >= 5 && part < 11)
        ted4_ray_add(w, &o);

    o = ted4_ray_solid(RAY_BOX, v3(.34f, .34f, .34f), v3(-.62f, .45f, .34f), 0.07);
    ted4_ray_dress(&o, RAY_FACES, cream, cream, cream);
    if (part < 8)
        ted4_ray_add(w, &o);

    o = ted4_ray_solid(RAY_CYLINDER, v3(.24f, .24f, .62f), v3(.72f, .42f, .62f), 0);
    ted4_ray_dress(&o, RAY_CHECKER, cream, ray_paint(.30f, .26f, .58f), ink);
    if (part >= 4)
        ted4_ray_add(w, &o);
}

/* A bar that stands in a pot sways and twists. */
static void bend(ted4_ray_world *w, double t)
{
    const vec3 ink = ray_paint(.17f, .18f, .24f);
    ted4_ray_object o = ted4_ray_solid(RAY_CYLINDER, v3(.36f, .36f, .12f), v3(0, .1f, .12f), 0);

    ted4_ray_dress(&o, RAY_WOOD, ray_paint(.80f, .52f, .36f), ray_paint(.52f, .28f, .20f), ink);
    ted4_ray_add(w, &o);

    o = ted4_ray_solid(RAY_BAR, v3(.2f, .2f, 1.5f), v3(0, .1f, .22f), 0.05);
    o.bend = 0.82f * (float)ted4_ray_sin(0.9 * t + 0.06);
    o.twist = 0.16f * (float)ted4_ray_sin(0.55 * t);
    ted4_ray_dress(&o, RAY_RIBBON, ray_paint(.24f, .62f, .58f), ray_paint(.90f, .42f, .24f), ink);
    ted4_ray_add(w, &o);
}

/* The carousel turns; a ball is present for three sixteenths of the sequence, and a box in its
 * first half. */
static void fair(ted4_ray_world *w, int frame, int n_frames)
{
    const vec3 cream = ray_paint(.95f, .91f, .82f);
    const int part = 16 * frame / n_frames;
    ted4_ray_object o = ted4_ray_solid(RAY_SPHERE, v3(.3f, .3f, .3f), v3(-.8f, -.2f, 1.2f), 0.1);

    ted4_ray_carousel(w, 0.04 + 0.33 * ted4_ray_time(frame, n_frames));
    ted4_ray_dress(&o, RAY_DOTS, ray_paint(.96f, .76f, .22f), ray_paint(.14f, .40f, .36f),
                   ray_paint(.80f, .22f, .30f));
    o.gloss = 0.2f;
    if (part >= 6 && part < 9)
        ted4_ray_add(w, &o);

    o = ted4_ray_solid(RAY_BOX, v3(.25f, .25f, .25f), v3(.42f, -1, .25f), 0.07);
    ted4_ray_dress(&o, RAY_FACES, cream, cream, cream);
    if (part < 8)
        ted4_ray_add(w, &o);
}

void ted4_ray_world_at(ted4_ray_world *w, ted4_ray_scene s, uint32_t seed, int frame, int n_frames)
{
    const double t = ted4_ray_time(frame, n_frames);

    ted4_ray_world_empty(w, seed);
    furniture(w);
    switch (s) {
    case RAY_TURN: ted4_ray_carousel(w, 0.04 + 0.33 * t); break;
    case RAY_OCCLUDER: occluder(w, t); break;
    case RAY_POP: pop(w, frame, n_frames); break;
    case RAY_BEND: bend(w, t); break;
    case RAY_FAIR: fair(w, frame, n_frames); break;
    case RAY_STILL: ted4_ray_carousel(w, 0.04); break;
    default: ted4_ray_lab_at(w, s, frame, n_frames);
    }
}
