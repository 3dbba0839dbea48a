/* ray_points.c - the initial points of a scene: see ted4_ray_point_at in ray_set.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "ray_rig.h"

#include <math.h>
#include <string.h>

/* Half the width of the noise added to the points, in units; it is two thirds of a default pixel at
 * the middle. */
static const float point_noise = 0.015f;
/* The largest error along the ray of a point as structure from motion finds it, in units. */
static const float depth_noise = 0.12f;

/* Middle and half width of the space that the things occupy in the room. */
static const vec3 things = { 0, 0.15f, 0.6f };
static const float things_half = 0.9f;

int ted4_ray_n_points(const ted4_ray_options *o)
{
    if (o->ways.points == RAY_NO_POINTS)
        return 0;
    if (o->ways.points == RAY_MOTION_POINTS)
        return TED4_RAY_FEW_POINTS;
    return o->ways.points == RAY_BOX10 ? TED4_RAY_MANY_POINTS : TED4_RAY_POINTS;
}

/* Returns what a training camera sees at a random position in a listed picture, and sets the camera
 * and time of p. */
static ted4_ray_sight random_sight(const ted4_ray_options *o, uint32_t seed, int i, int attempt,
                                   ted4_ray_point *p)
{
    ted4_ray_camera c;
    ted4_ray_world w;

    p->camera = (i + attempt) % o->n_train;
    p->frame = (int)(ray_hash(i, 0, attempt, seed) % (uint32_t)o->n_frames);
    p->frame += ted4_ray_is_held(o, p->frame);
    if (!ted4_ray_is_taken(o, p->camera, p->frame))
        return (ted4_ray_sight) { .depth = INFINITY };
    ted4_ray_camera_of(o, p->camera, &c);
    ted4_ray_world_of(o, p->frame, &w);
    return ted4_ray_look(&w, &c, (double)ray_random(i, 1, attempt, seed) * c.width,
                         (double)ray_random(i, 2, attempt, seed) * c.height);
}

static ted4_ray_point random_point(const ted4_ray_options *o, int i)
{
    const float half = things_half * (o->ways.points == RAY_BOX10 ? 10 : 1);
    const uint32_t seed = o->seed + 78;
    ted4_ray_point p = { .camera = -1 };
    double room[3], file[3];
    const vec3 from = v3(2 * ray_random(i, 0, 0, seed) - 1, 2 * ray_random(i, 1, 0, seed) - 1,
                         2 * ray_random(i, 2, 0, seed) - 1);
    const vec3 at = v3_along(things, from, half);

    room[0] = (double)at.x, room[1] = (double)at.y, room[2] = (double)at.z;
    ted4_ray_mapped(o, room, file);
    p.point = v3((float)file[0], (float)file[1], (float)file[2]);
    for (int k = 0; k < 3; k++)
        p.rgb[k] = (uint8_t)(ray_hash(i, 3, k, seed) >> 24);
    return p;
}

/* Returns a random vector in a cube of edge 1 about the origin. */
static vec3 noise(uint32_t seed, int i, int channel)
{
    return v3(ray_random(i, channel, 0, seed) - 0.5f, ray_random(i, channel + 1, 0, seed) - 0.5f,
              ray_random(i, channel + 2, 0, seed) - 0.5f);
}

/* This ends because the first training camera always has things in view. */
static ted4_ray_point surface_point(const ted4_ray_options *o, int i)
{
    const uint32_t seed = o->seed + 77;
    ted4_ray_point p;
    ted4_ray_sight s;
    int attempt = 0;

    do {
        s = random_sight(o, seed, i, attempt++, &p);
    } while (!isfinite(s.depth));
    ted4_ray_bytes(s.colour, p.rgb);
    p.point = v3_along(s.point, noise(seed, i, 3), 2 * point_noise);
    p.point = ted4_ray_point_stated(o, p.camera, p.point);
    return p;
}

/* ---- as structure from motion finds them ---- */

static int is_same_place(const ted4_ray_object *a, const ted4_ray_object *b)
{
    return a->kind == b->kind && memcmp(&a->size, &b->size, sizeof a->size) == 0 &&
           memcmp(a->rot, b->rot, sizeof a->rot) == 0 &&
           memcmp(&a->pos, &b->pos, sizeof a->pos) == 0 && a->bend == b->bend &&
           a->twist == b->twist && memcmp(&a->skin, &b->skin, sizeof a->skin) == 0;
}

/* Returns 1 if an object stands at the same place at all times. */
static int is_still(const ted4_ray_options *o, const ted4_ray_object *object)
{
    for (int frame = 0; frame < o->n_frames; frame++) {
        ted4_ray_world w;
        int found = 0;

        ted4_ray_world_of(o, frame, &w);
        for (int k = 0; k < w.n && !found; k++)
            found = is_same_place(object, &w.object[k]);
        if (!found)
            return 0;
    }
    return 1;
}

/* Returns 1 if a sight at a time is of something that stands still. */
static int sees_still(const ted4_ray_options *o, const ted4_ray_sight *s, int frame)
{
    ted4_ray_world w;

    if (s->object < 0)
        return s->object == -1;
    ted4_ray_world_of(o, frame, &w);
    return is_still(o, &w.object[s->object]);
}

/* Finds a point on what never moves. It lies off its surface by as much as other points, and along
 * the camera's ray by up to depth_noise, since cameras tell directions better than depths. Its
 * colour is the one that the camera takes, with the camera's tint and exposure. This ends because
 * every scene has things that stand still. */
static ted4_ray_point motion_point(const ted4_ray_options *o, int i)
{
    const uint32_t seed = o->seed + 79;
    ted4_ray_point p;
    ted4_ray_sight s;
    ted4_ray_camera c;
    int attempt = 0;

    do {
        s = random_sight(o, seed, i, attempt++, &p);
    } while (!isfinite(s.depth) || !sees_still(o, &s, p.frame));
    ted4_ray_camera_of(o, p.camera, &c);
    ted4_ray_expose(o, p.camera, p.frame, &c);
    ted4_ray_bytes(ray_rotate(c.colour, s.colour), p.rgb);
    const vec3 eye = v3((float)c.matrix[0][3], (float)c.matrix[1][3], (float)c.matrix[2][3]);
    const float along = depth_noise * (ray_random(i, 6, 0, seed) + ray_random(i, 6, 1, seed) - 1);

    p.point = v3_along(s.point, noise(seed, i, 3), 2 * point_noise);
    p.point = v3_along(p.point, v3_unit(v3_sub(s.point, eye)), along);
    p.point = ted4_ray_point_stated(o, p.camera, p.point);
    return p;
}

ted4_ray_point ted4_ray_point_at(const ted4_ray_options *o, int i)
{
    switch (o->ways.points) {
    case RAY_ON_SURFACES: return surface_point(o, i);
    case RAY_MOTION_POINTS: return motion_point(o, i);
    default: return random_point(o, i);
    }
}
