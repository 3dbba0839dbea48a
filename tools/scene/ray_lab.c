/* ray_lab.c - one function per scene. Events occur at fixed shares of the sequence. They are chosen
 * so that with the default length no held-out time (ray_scene.h) is next to a change of what
 * exists, where nobody could know on which side of the change that time lies. Speeds are per frame.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "ray_lab.h"

#include <stddef.h>

#include "ray_texture.h"

static vec3 cream(void)
{
    return ray_paint(.95f, .91f, .82f);
}
static vec3 ink(void)
{
    return ray_paint(.15f, .16f, .22f);
}

static void add_ball(ted4_ray_world *w, float r, vec3 pos, ted4_ray_texture_kind texture)
{
    ted4_ray_object o = ted4_ray_solid(RAY_SPHERE, v3(r, r, r), pos, 0.1);

    ted4_ray_dress(&o, texture, ray_paint(.96f, .76f, .22f), ray_paint(.14f, .40f, .36f),
                   ray_paint(.80f, .22f, .30f));
    o.gloss = 0.2f;
    ted4_ray_add(w, &o);
}

static void add_box(ted4_ray_world *w, float half, vec3 pos, double turns)
{
    ted4_ray_object o = ted4_ray_solid(RAY_BOX, v3(half, half, half), pos, turns);

    ted4_ray_dress(&o, RAY_FACES, cream(), cream(), cream());
    ted4_ray_add(w, &o);
}

static void add_column(ted4_ray_world *w, vec3 pos)
{
    ted4_ray_object o = ted4_ray_solid(RAY_CYLINDER, v3(.22f, .22f, pos.z), pos, 0);

    ted4_ray_dress(&o, RAY_CHECKER, cream(), ray_paint(.30f, .26f, .58f), ink());
    ted4_ray_add(w, &o);
}

/* The carousel of the scene "turn". */
static void turn(ted4_ray_world *w, double t)
{
    ted4_ray_carousel(w, 0.04 + 0.33 * t);
}

/* A ball rolls behind a wall that hides it from every camera, and returns. */
static void hide(ted4_ray_world *w, double t)
{
    const float r = 0.3f, x = -0.85f - 0.85f * (float)ted4_ray_cos(t);
    ted4_ray_object o = ted4_ray_solid(RAY_BOX, v3(1.0f, .09f, .6f), v3(.1f, .25f, .6f), 0);

    ted4_ray_dress(&o, RAY_BRICK, ray_paint(.44f, .52f, .60f), ray_paint(.68f, .72f, .76f),
                   ray_paint(.90f, .88f, .82f));
    ted4_ray_add(w, &o);

    o = ted4_ray_solid(RAY_SPHERE, v3(r, r, r), v3(x, .7f, r), 0);
    ted4_ray_turn(o.rot, 1, (double)(x / r) / (2 * RAY_PI));
    ted4_ray_dress(&o, RAY_BEACH, ray_paint(.96f, .93f, .86f), ray_paint(.88f, .28f, .22f),
                   ray_paint(.18f, .36f, .68f));
    o.gloss = 0.2f;
    ted4_ray_add(w, &o);
}

/* In sixteenths of the sequence: a ball is present in [6, 10), a column in [8, 11), and a box in
 * [0, 2), [7, 9) and [14, 16). */
static void blink(ted4_ray_world *w, int frame, int n_frames)
{
    const int part = 16 * frame / n_frames;

    if (part >= 6 && part < 10)
        add_ball(w, .42f, v3(.05f, -.3f, .42f), RAY_DOTS);
    if (part >= 8 && part < 11)
        add_column(w, v3(.72f, .42f, .62f));
    if (part < 2 || part == 7 || part == 8 || part >= 14)
        add_box(w, .34f, v3(-.62f, .45f, .34f), 0.07);
}

/* The same times as in blink, but at places where a small motion would take an absent thing out of
 * every picture. */
static void edge(ted4_ray_world *w, int frame, int n_frames)
{
    const int part = 16 * frame / n_frames;

    if (part >= 6 && part < 10)
        add_ball(w, .42f, v3(-1, -.3f, 2.15f), RAY_DOTS);
    if (part >= 8 && part < 11)
        add_box(w, .36f, v3(.1f, -.35f, 2.2f), 0.07);
    if (part < 2 || part == 7 || part == 8 || part >= 14)
        add_box(w, .34f, v3(1, -.45f, 2.2f), 0.07);
}

/* Returns the position on a path of n steps there and n steps back. */
static int there_and_back(int frame, int n)
{
    const int k = frame % (2 * n);

    return k <= n ? k : 2 * n - k;
}

/* Next to the carousel, which stands still, a ball moves to and fro by two of its widths per frame,
 * and a box up and down by 1.8. Neither reverses at a time that is held out by default. */
static void fast(ted4_ray_world *w, int frame)
{
    const int ball = there_and_back(frame, 5), box = there_and_back(frame + 1, 3);

    ted4_ray_carousel(w, 0.04);
    add_ball(w, .13f, v3(-1.3f + .52f * (float)ball, -.35f, 1.35f), RAY_DOTS);
    add_box(w, .14f, v3(.98f, .2f, .14f + .5f * (float)box), 0);
}

/* Adds one half, on side -1 or 1, of a marble block, at distance gap from the middle. */
static void add_half(ted4_ray_world *w, float side, float gap)
{
    ted4_ray_object o =
        ted4_ray_solid(RAY_BOX, v3(.27f, .27f, .4f), v3(side * (.27f + gap), .1f, .4f), 0);

    ted4_ray_dress(&o, RAY_MARBLE, ray_paint(.86f, .34f, .24f), ray_paint(.97f, .90f, .66f), ink());
    o.skin = v3(side * .27f, 0, 0);
    ted4_ray_add(w, &o);
}

/* A block splits in two halves; then two balls in front of it become one. */
static void split(ted4_ray_world *w, double t)
{
    const float apart = .5f * ray_step(.1f, .5f, (float)t);
    const float near = .78f * (1 - ray_step(.4f, .85f, (float)t));

    add_half(w, -1, apart);
    add_half(w, 1, apart);
    add_ball(w, .25f, v3(-near, -.5f, .25f), RAY_DOTS);
    add_ball(w, .25f, v3(near, -.5f, .25f), RAY_DOTS);
}

float ted4_ray_flicker(int frame, uint32_t seed)
{
    return (frame % 2 == 0 ? 1.0f : 0.1f) + 0.3f * ray_random(frame, 0, 0, seed + 501);
}

static void flicker(ted4_ray_world *w, int frame, int n_frames)
{
    ted4_ray_carousel(w, 0.04 + 0.15 * ted4_ray_time(frame, n_frames));
    w->lamp_power *= ted4_ray_flicker(frame, w->seed);
}

/* The carousel turns once in 120 frames, and a ball goes round above it once in 150. A box is
 * present from 44 to 68 hundredths of the sequence. */
static void longer(ted4_ray_world *w, int frame, int n_frames)
{
    const int part = 100 * frame / n_frames;
    const double a = frame / 150.0;

    ted4_ray_carousel(w, 0.04 + frame / 120.0);
    add_ball(w, .24f, v3(1.1f * (float)ted4_ray_cos(a), .1f + .9f * (float)ted4_ray_sin(a), 1.4f),
             RAY_DOTS);
    if (part >= 44 && part < 68)
        add_box(w, .25f, v3(.42f, -1, .25f), 0.07);
}

/* Adds a rod of radius r from a to b. */
static void add_rod(ted4_ray_world *w, vec3 a, vec3 b, float r, vec3 colour)
{
    const vec3 z = v3_unit(v3_sub(b, a)), aside = fabsf(z.z) < 0.7f ? v3(0, 0, 1) : v3(1, 0, 0);
    const vec3 x = v3_unit(v3_along(aside, z, -v3_dot(aside, z)));
    ted4_ray_object o =
        ted4_ray_solid(RAY_CYLINDER, v3(r, r, .5f * v3_length(v3_sub(b, a))), v3_mix(a, b, .5f), 0);
    const float rot[9] = { x.x, z.y * x.z - z.z * x.y, z.x, x.y, z.z * x.x - z.x * x.z, z.y,
                           x.z, z.x * x.y - z.y * x.x, z.z };

    for (int i = 0; i < 9; i++)
        o.rot[i] = rot[i];
    ted4_ray_dress(&o, RAY_FLAT, colour, colour, colour);
    o.gloss = 0.3f;
    ted4_ray_add(w, &o);
}

/* Returns corner i of a cage that is turned about the middle; the bits of i are x, y, z. */
static vec3 corner(int i, double turns)
{
    const float x = i & 1 ? .55f : -.55f, y = i & 2 ? .55f : -.55f;
    const float c = (float)ted4_ray_cos(turns), s = (float)ted4_ray_sin(turns);

    return v3(c * x - s * y, .1f + s * x + c * y, i & 4 ? 1.45f : .35f);
}

/* A cage of wires, with a ball in it, turns on a thread, and two lines cross the room. Wires are
 * about two thirds of a default pixel wide. */
static void wires(ted4_ray_world *w, double t)
{
    const float r = 0.013f;
    const vec3 steel = ray_paint(.88f, .88f, .90f), brass = ray_paint(.95f, .72f, .25f);
    const double turns = 0.03 + 0.25 * t;

    for (int i = 0; i < 8; i++) {
        for (int axis = 1; axis < 8; axis *= 2) {
            if ((i & axis) == 0)
                add_rod(w, corner(i, turns), corner(i | axis, turns), r, steel);
        }
        if (i & 4)
            add_rod(w, corner(i, turns), v3(0, .1f, 2), r, brass);
    }
    add_rod(w, v3(0, .1f, 2), v3(0, .1f, 3.2f), r, brass);
    add_rod(w, v3(-2.7f, .9f, 2.05f), v3(2.7f, 1.2f, 2.15f), r, ink());
    add_rod(w, v3(-2.7f, -.7f, 1.5f), v3(2.7f, 1.5f, 1.6f), r, brass);
    add_ball(w, .26f, v3(0, .1f, .9f), RAY_DOTS);
}

/* The things in the middle at the beginning are all gone at the end. In sixteenths of the sequence:
 * a box until 6, a column until 9, a ball from 7, a bar from 10. */
static void change(ted4_ray_world *w, int frame, int n_frames)
{
    const int part = 16 * frame / n_frames;
    ted4_ray_object o = ted4_ray_solid(RAY_BAR, v3(.19f, .19f, 1.3f), v3(.65f, .25f, 0), 0.05);

    if (part < 6)
        add_box(w, .42f, v3(-.35f, -.35f, .42f), 0.07);
    if (part < 9)
        add_column(w, v3(.7f, -.5f, .55f));
    if (part >= 7)
        add_ball(w, .4f, v3(-.4f, .2f, .4f), RAY_DOTS);
    if (part < 10)
        return;
    o.bend = 0.5f;
    ted4_ray_dress(&o, RAY_RIBBON, ray_paint(.24f, .62f, .58f), ray_paint(.90f, .42f, .24f), ink());
    ted4_ray_add(w, &o);
}

/* The carousel and the furniture on a round stage, surrounded by darkness. */
static void stage(ted4_ray_world *w, double t)
{
    ted4_ray_object o = ted4_ray_solid(RAY_CYLINDER, v3(2.65f, 2.65f, .1f), v3(0, .1f, -.1f), 0);

    w->room = RAY_DARK;
    ted4_ray_dress(&o, RAY_CHECKER, ray_paint(.70f, .62f, .52f), ray_paint(.42f, .32f, .27f),
                   ink());
    ted4_ray_add(w, &o);
    turn(w, t);
}

/* Returns the number of moving things of a scene for file sizes. */
static int n_things(ted4_ray_scene s)
{
    switch (s) {
    case RAY_THINGS1: return 1;
    case RAY_THINGS2: return 2;
    case RAY_THINGS4:
    case RAY_REST: return 4;
    case RAY_THINGS8: return 8;
    default: return 0;
    }
}

void ted4_ray_lab_at(ted4_ray_world *w, ted4_ray_scene s, int frame, int n_frames)
{
    const double t = ted4_ray_time(frame, n_frames);
    const int half = n_frames / 2;

    if (s == RAY_TOYS) {
        ted4_ray_toys(w, t);
        return;
    }
    if (s == RAY_RELAY) {
        ted4_ray_relay(w, t, frame);
        return;
    }
    if (s >= RAY_THINGS0) {
        ted4_ray_things(w, n_things(s), s == RAY_REST && frame > half ? half : frame);
        return;
    }
    switch (s) {
    case RAY_HIDE: hide(w, t); break;
    case RAY_BLINK: blink(w, frame, n_frames); break;
    case RAY_EDGE: edge(w, frame, n_frames); break;
    case RAY_FAST: fast(w, frame); break;
    case RAY_SPLIT: split(w, t); break;
    case RAY_FLICKER: flicker(w, frame, n_frames); break;
    case RAY_LONG: longer(w, frame, n_frames); break;
    case RAY_WIRES: wires(w, t); break;
    case RAY_CHANGE: change(w, frame, n_frames); break;
    case RAY_EMPTY: stage(w, t); break;
    case RAY_BARE:
        w->room = RAY_PLAIN;
        turn(w, t);
        break;
    default: turn(w, t);
    }
}
