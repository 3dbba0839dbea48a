/* ray_relay.c - things that move before cameras of which only one sees any time.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "ray_lab.h"

#include "ray_texture.h"

enum { DROPS = 6 };

static const vec3 middle = { 0, .15f, 0 };

static void add(ted4_ray_world *w, ted4_ray_object o, ted4_ray_texture_kind texture, vec3 a, vec3 b)
{
    ted4_ray_dress(&o, texture, a, b, ray_paint(.80f, .22f, .30f));
    o.gloss = o.kind == RAY_SPHERE ? 0.2f : 0.0f;
    ted4_ray_add(w, &o);
}

static void add_still_things(ted4_ray_world *w)
{
    const vec3 cream = ray_paint(.95f, .91f, .82f);

    add(w, ted4_ray_solid(RAY_CYLINDER, v3(1, 1, .04f), v3_add(middle, v3(0, 0, .04f)), 0),
        RAY_CHECKER, ray_paint(.86f, .84f, .78f), ray_paint(.46f, .46f, .50f));
    add(w,
        ted4_ray_solid(RAY_CYLINDER, v3(.14f, .14f, .3f), v3_add(middle, v3(-.3f, .2f, .38f)), 0),
        RAY_SPIRAL, cream, ray_paint(.20f, .42f, .70f));
    add(w, ted4_ray_solid(RAY_BOX, v3(.18f, .18f, .18f), v3_add(middle, v3(.3f, .1f, .26f)), 0.07),
        RAY_FACES, cream, cream);
}

/* The block hangs from a point above the disk, and swings to and fro twice. */
static void add_pendulum(ted4_ray_world *w, double t)
{
    const double turns = 0.09 * ted4_ray_sin(2 * t + 0.1);
    const vec3 down = v3(-(float)ted4_ray_sin(turns), 0, -(float)ted4_ray_cos(turns));
    const vec3 from = v3_add(middle, v3(0, .1f, 1.9f));
    ted4_ray_object rod =
        ted4_ray_solid(RAY_CYLINDER, v3(.03f, .03f, .4f), v3_along(from, down, .4f), 0);
    ted4_ray_object block = ted4_ray_solid(RAY_BOX, v3(.2f, .2f, .2f), v3_along(from, down, 1), 0);

    ted4_ray_turn(rod.rot, 1, turns);
    ted4_ray_turn(block.rot, 1, turns);
    add(w, rod, RAY_FLAT, ray_paint(.30f, .28f, .34f), ray_paint(.30f, .28f, .34f));
    add(w, block, RAY_CHECKER, ray_paint(.90f, .55f, .20f), ray_paint(.25f, .20f, .45f));
}

void ted4_ray_relay(ted4_ray_world *w, double t, int frame)
{
    const double bounce = ted4_ray_sin(2 * t);
    const vec3 ball = v3(.72f * (float)ted4_ray_cos(t), .72f * (float)ted4_ray_sin(t),
                         .26f + .25f * (float)(bounce * bounce));

    w->n = 0;
    w->lamp = v3(-.9f, -.7f, 2.9f);
    add_still_things(w);
    add(w, ted4_ray_solid(RAY_SPHERE, v3(.18f, .18f, .18f), v3_add(middle, ball), t), RAY_BEACH,
        ray_paint(.95f, .90f, .80f), ray_paint(.16f, .60f, .30f));
    add_pendulum(w, t);
    for (int k = 0; k < DROPS; k++) {
        const float z = 1.4f + 1.1f * (float)k - .05f * (float)frame;

        add(w,
            ted4_ray_solid(RAY_SPHERE, v3(.09f, .09f, .09f),
                           v3(k % 2 ? 1.15f : -1.15f, .1f * (float)k - .1f, z), 0),
            RAY_FLAT, ray_paint(.15f, .45f, .80f), ray_paint(.15f, .45f, .80f));
    }
}
