/* ray_things.c - things for the scenes that show how file size depends on content. The eight things
 * are always the same; some of them move, each at its own place and in its own way.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "ray_lab.h"

#include "ray_texture.h"

enum { THINGS = 8, SECOND = 16 };

/* Kind; texture; half size; place on the floor (a thing stays within 0.13 of it); motion sideways,
 * in depth and upwards (units), and rotation (turns); rate (turns per second). The rates are
 * incommensurable, so that no two times are alike. */
typedef struct {
    ted4_ray_kind kind;
    ted4_ray_texture_kind texture;
    float size, x, y;
    float across, along, up, about;
    double rate;
} thing;

/* In the order in which they begin to move, so that the first ones are far from each other. */
static const thing things[THINGS] = {
    { RAY_SPHERE, RAY_BEACH, .17f, -.30f, -.75f, .10f, .08f, .22f, .30f, .83 },
    { RAY_BOX, RAY_FACES, .15f, .86f, .30f, .10f, .00f, .10f, .25f, .71 },
    { RAY_CYLINDER, RAY_CHECKER, .15f, -.86f, .35f, .10f, .10f, .00f, .40f, .64 },
    { RAY_BOX, RAY_MARBLE, .15f, .32f, -.70f, .00f, .10f, .18f, .20f, .94 },
    { RAY_SPHERE, RAY_DOTS, .18f, .30f, .40f, .12f, .00f, .25f, .00f, .77 },
    { RAY_CYLINDER, RAY_SPIRAL, .14f, -.28f, .28f, .00f, .12f, .12f, .45f, .58 },
    { RAY_BOX, RAY_RIBBON, .14f, -.85f, -.72f, .08f, .08f, .14f, .30f, .89 },
    { RAY_SPHERE, RAY_WOOD, .16f, .84f, -.38f, .10f, .06f, .20f, .35f, .67 },
};

static const float palette[THINGS][2][3] = {
    { { .96f, .93f, .86f }, { .88f, .28f, .22f } }, { { .95f, .91f, .82f }, { .95f, .91f, .82f } },
    { { .95f, .90f, .80f }, { .16f, .42f, .62f } }, { { .24f, .55f, .42f }, { .93f, .95f, .84f } },
    { { .96f, .76f, .22f }, { .14f, .40f, .36f } }, { { .92f, .88f, .80f }, { .70f, .24f, .52f } },
    { { .28f, .60f, .74f }, { .92f, .48f, .24f } }, { { .88f, .64f, .36f }, { .46f, .26f, .16f } },
};

static vec3 paint(const float c[3])
{
    return ray_paint(c[0], c[1], c[2]);
}

/* Returns a weighted sum of two sines of rates 1 and the golden ratio: 0 at time 0, within [-1, 1].
 */
static float wave(double turns)
{
    return (float)(0.7 * ted4_ray_sin(turns) + 0.3 * ted4_ray_sin(1.618033988749895 * turns));
}

void ted4_ray_things(ted4_ray_world *w, int n_moving, int frames)
{
    for (int i = 0; i < THINGS; i++) {
        const thing *const k = &things[i];
        const double turns = i < n_moving ? k->rate * frames / SECOND : 0;
        const float a = wave(turns), b = wave(0.81 * turns);
        const vec3 at = v3(k->x + k->across * a, k->y + k->along * b,
                           k->size + k->up * fabsf(wave(0.5 * turns)));
        ted4_ray_object o = ted4_ray_solid(k->kind, v3(k->size, k->size, k->size), at,
                                           0.03 * i + (double)(k->about * wave(0.37 * turns)));

        ted4_ray_dress(&o, k->texture, paint(palette[i][0]), paint(palette[i][1]),
                       ray_paint(.18f, .22f, .34f));
        o.gloss = o.kind == RAY_SPHERE ? 0.2f : 0.0f;
        ted4_ray_add(w, &o);
    }
}
