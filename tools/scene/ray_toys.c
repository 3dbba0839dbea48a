/* ray_toys.c - a scene like the small scenes of other people: a few things in empty space that fill
 * about a tenth of the picture, one that goes round, and some that are a few pixels wide.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "ray_lab.h"

#include "ray_texture.h"

enum { DROPLETS = 4 };

static void add(ted4_ray_world *w, ted4_ray_object o, ted4_ray_texture_kind texture, vec3 a, vec3 b)
{
    ted4_ray_dress(&o, texture, a, b, ray_paint(.80f, .22f, .30f));
    o.gloss = o.kind == RAY_SPHERE ? 0.2f : 0.0f;
    ted4_ray_add(w, &o);
}

static void still_ones(ted4_ray_world *w, vec3 middle)
{
    const vec3 cream = ray_paint(.95f, .91f, .82f);

    add(w, ted4_ray_solid(RAY_CYLINDER, v3(.8f, .8f, .03f), v3_add(middle, v3(0, 0, .03f)), 0),
        RAY_CHECKER, ray_paint(.86f, .84f, .78f), ray_paint(.46f, .46f, .50f));
    add(w, ted4_ray_solid(RAY_SPHERE, v3(.22f, .22f, .22f), v3_add(middle, v3(-.3f, .1f, .28f)), 0),
        RAY_DOTS, cream, ray_paint(.82f, .26f, .20f));
    add(w,
        ted4_ray_solid(RAY_BOX, v3(.17f, .17f, .17f), v3_add(middle, v3(.28f, .25f, .23f)), 0.07),
        RAY_FACES, cream, cream);
    add(w,
        ted4_ray_solid(RAY_CYLINDER, v3(.12f, .12f, .2f), v3_add(middle, v3(.1f, -.3f, .26f)), 0),
        RAY_SPIRAL, cream, ray_paint(.20f, .42f, .70f));
}

/* The ball, with its shadow on the disk, goes round once and up and down twice. A droplet falls
 * during the whole sequence. */
void ted4_ray_toys(ted4_ray_world *w, double t)
{
    const vec3 middle = v3(0, .15f, 0);
    const vec3 ball = v3(.58f * (float)ted4_ray_cos(t), .58f * (float)ted4_ray_sin(t),
                         .32f + .1f * (float)ted4_ray_sin(2 * t));

    w->n = 0;
    w->lamp = v3(-.9f, -.7f, 2.9f);
    still_ones(w, middle);
    add(w, ted4_ray_solid(RAY_SPHERE, v3(.14f, .14f, .14f), v3_add(middle, ball), t), RAY_BEACH,
        ray_paint(.95f, .90f, .80f), ray_paint(.16f, .60f, .30f));
    for (int k = 0; k < DROPLETS; k++) {
        const double turns = 0.2 + 0.25 * k + 0.3 * t;
        const vec3 at = v3(.34f * (float)ted4_ray_cos(turns), .34f * (float)ted4_ray_sin(turns),
                           1.05f - .16f * (float)k - .35f * (float)t);

        add(w, ted4_ray_solid(RAY_SPHERE, v3(.07f, .07f, .07f), v3_add(middle, at), 0), RAY_FLAT,
            ray_paint(.92f, .74f, .12f), ray_paint(.92f, .74f, .12f));
    }
}
