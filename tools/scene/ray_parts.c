/* ray_parts.c - the parts of all scenes: an empty room, solids, and the carousel. See ray_world.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "ray_world.h"

#include <stddef.h>

#include "ray_texture.h"

double ted4_ray_time(int frame, int n_frames)
{
    return n_frames > 1 ? (double)frame / (double)(n_frames - 1) : 0.0;
}

void ted4_ray_world_empty(ted4_ray_world *w, uint32_t seed)
{
    w->room = RAY_PAPERED;
    w->room_low = v3(-2.7f, -4.2f, 0);
    w->room_high = v3(2.7f, 2.1f, 3.2f);
    w->lamp = v3(-2.3f, -1.7f, 2.7f);
    w->lamp_x = v3(0.24f, 0, 0);
    w->lamp_y = v3(0, 0.24f, 0);
    w->lamp_power = 12.0f;
    w->n = 0;
    w->seed = seed;
}

ted4_ray_object *ted4_ray_add(ted4_ray_world *w, const ted4_ray_object *o)
{
    ted4_ray_object *const mine = &w->object[w->n];

    if (w->n == TED4_RAY_MAX_OBJECTS)
        return NULL;
    *mine = *o;
    ted4_ray_bound(mine);
    w->n++;
    return mine;
}

void ted4_ray_turn(float m[9], int axis, double turns)
{
    const float c = (float)ted4_ray_cos(turns), s = (float)ted4_ray_sin(turns);
    const int a = (axis + 1) % 3, b = (axis + 2) % 3;

    for (int i = 0; i < 9; i++)
        m[i] = i % 4 == 0 ? 1.0f : 0.0f;
    m[a * 3 + a] = m[b * 3 + b] = c;
    m[a * 3 + b] = -s;
    m[b * 3 + a] = s;
}

ted4_ray_object ted4_ray_solid(ted4_ray_kind kind, vec3 size, vec3 pos, double turns)
{
    ted4_ray_object o = { .kind = kind, .size = size, .pos = pos };

    ted4_ray_turn(o.rot, 2, turns);
    return o;
}

void ted4_ray_dress(ted4_ray_object *o, ted4_ray_texture_kind texture, vec3 a, vec3 b, vec3 c)
{
    o->texture = texture;
    o->colour[0] = a;
    o->colour[1] = b;
    o->colour[2] = c;
}

void ted4_ray_carousel(ted4_ray_world *w, double turns)
{
    const vec3 cream = ray_paint(.95f, .91f, .82f), ink = ray_paint(.15f, .16f, .22f);
    const vec3 at = v3(0, .1f, 0);
    ted4_ray_object o =
        ted4_ray_solid(RAY_CYLINDER, v3(.74f, .74f, .09f), v3_add(at, v3(0, 0, .09f)), turns);

    ted4_ray_dress(&o, RAY_WOOD, ray_paint(.70f, .62f, .56f), ray_paint(.36f, .30f, .30f), ink);
    ted4_ray_add(w, &o);

    o = ted4_ray_solid(RAY_BOX, v3(.40f, .34f, .42f), v3_add(at, v3(0, 0, .6f)), turns);
    ted4_ray_dress(&o, RAY_FACES, cream, cream, cream);
    ted4_ray_add(w, &o);

    o = ted4_ray_solid(RAY_CYLINDER, v3(.07f, .07f, .2f), v3_add(at, v3(0, 0, 1.2f)), turns);
    o.pos = v3_add(v3_add(at, v3(0, 0, 1.2f)), ray_rotate(o.rot, v3(.24f, .14f, 0)));
    ted4_ray_dress(&o, RAY_SPIRAL, cream, ink, ink);
    ted4_ray_add(w, &o);

    o = ted4_ray_solid(RAY_SPHERE, v3(.23f, .23f, .23f), v3(0, 0, 0), turns);
    o.pos = v3_add(v3_add(at, v3(0, 0, 1.52f)), ray_rotate(o.rot, v3(.24f, .14f, 0)));
    ted4_ray_dress(&o, RAY_BEACH, ray_paint(.95f, .78f, .22f), ray_paint(.20f, .42f, .70f),
                   ray_paint(.85f, .25f, .25f));
    o.gloss = 0.2f;
    ted4_ray_add(w, &o);
}
