/* ray_texture.c - wood, marble, checkers, stripes, dots, bricks and planks: functions of position,
 * with soft edges and hash noise. The finest period is about 0.05 units, which is two and a half
 * pixels of the default picture at the distance of the middle.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "ray_texture.h"

/* Half the width of the soft edge between two colours, in units. */
#define EDGE 0.006f

/* Returns 1 in the odd cells of a row of period 2 p, and 0 in the even ones. */
static float bars(float x, float p)
{
    const float f = 2 * p * ray_fract(x / (2 * p)), e = ray_min(EDGE, p / 4);

    return ray_step(p - e, p + e, f) - ray_step(2 * p - e, 2 * p + e, f) + (1 - ray_step(-e, e, f));
}

static float exclusive(float a, float b)
{
    return a + b - 2 * a * b;
}

/* Returns 1 inside and 0 outside a shape; d is the outward distance from it. */
static float inside(float d)
{
    return 1 - ray_step(-EDGE, EDGE, d);
}

static float length2(float x, float y)
{
    return sqrtf(x * x + y * y);
}

static float grain(vec3 p, uint32_t seed)
{
    return 0.8f + 0.25f * ted4_ray_noise3(v3_scale(p, 9), seed) +
           0.15f * ted4_ray_noise3(v3_scale(p, 21), seed + 1);
}

static vec3 wood(const ted4_ray_object *o, vec3 p, uint32_t seed)
{
    const float warp = ted4_ray_noise3(v3(p.x * 3, p.y * 3, p.z * 1.2f), seed);
    const float ring = ray_fract(9 * length2(p.x + 0.3f, p.y - 0.6f) + 1.6f * warp);
    const float fibre = ted4_ray_noise3(v3(p.x * 26, p.y * 26, p.z * 3), seed + 2);
    const vec3 c = v3_mix(o->colour[0], o->colour[1], ring * ray_step(1, 0.8f, ring));

    return v3_scale(c, 0.72f + 0.5f * fibre);
}

static vec3 marble(const ted4_ray_object *o, vec3 p, uint32_t seed)
{
    const float warp = ted4_ray_noise3(v3_scale(p, 4), seed) +
                       0.5f * ted4_ray_noise3(v3_scale(p, 9), seed + 1);
    const float wave = (float)ted4_ray_sin((double)(2.2f * p.x + 1.5f * p.z + 1.3f * warp));
    const vec3 c = v3_mix(o->colour[0], o->colour[1], ray_step(0.35f, 0.95f, fabsf(wave)));

    return v3_scale(c, 0.85f + 0.3f * ted4_ray_noise3(v3_scale(p, 18), seed + 2));
}

static vec3 checker(const ted4_ray_object *o, vec3 p, uint32_t seed)
{
    const float s = 0.14f;
    const float c = exclusive(exclusive(bars(p.x, s), bars(p.y, s)), bars(p.z + 0.5f * s, s));

    return v3_scale(v3_mix(o->colour[0], o->colour[1], c), grain(p, seed));
}

static vec3 spiral(const ted4_ray_object *o, vec3 p, uint32_t seed)
{
    const float turn = ted4_ray_atan2(p.y, p.x) / (float)(2 * RAY_PI);
    const float f = ray_fract(2 * turn + 2.6f * p.z);
    vec3 c =
        v3_mix(o->colour[0], o->colour[1], ray_step(0.48f, 0.52f, f) - ray_step(0.98f, 1.02f, f));

    c = v3_mix(c, o->colour[2], inside(fabsf(f - 0.25f) * 0.3f - 0.025f));
    return v3_scale(c, grain(p, seed));
}

/* Each cell of a lattice contains one ball of random place and size, which the surface intersects.
 */
static vec3 dots(const ted4_ray_object *o, vec3 p, uint32_t seed)
{
    const float cell = 0.19f;
    const vec3 q = v3_scale(p, 1 / cell);
    const int i = ray_floor(q.x), j = ray_floor(q.y), k = ray_floor(q.z);
    const vec3 at = v3(0.4f + 0.2f * ray_random(i, j, k, seed),
                       0.4f + 0.2f * ray_random(i, j, k, seed + 1),
                       0.4f + 0.2f * ray_random(i, j, k, seed + 2));
    const float d = v3_length(v3_sub(v3_sub(q, v3((float)i, (float)j, (float)k)), at));
    const vec3 ink = ray_random(i, j, k, seed + 3) < 0.5f ? o->colour[1] : o->colour[2];

    return v3_scale(v3_mix(o->colour[0], ink, inside((d - 0.39f) * cell)), grain(p, seed));
}

/* Returns the share of the second colour in pattern number n (0..5) of a box face at face
 * coordinates u, v. */
static float face_pattern(int n, float u, float v)
{
    const float r = length2(u, v);

    switch (n) {
    case 0: return bars(r, 0.075f);
    case 1: return exclusive(bars(u, 0.13f), bars(v, 0.13f));
    case 2: return bars(u + v, 0.1f);
    case 3: return inside(ray_min(fabsf(u), fabsf(v)) - 0.08f);
    case 4:
        return inside(
            length2(0.22f * ray_fract(u / 0.22f) - 0.11f, 0.22f * ray_fract(v / 0.22f) - 0.11f) -
            0.065f);
    default: return inside(fabsf(r - 0.22f) - 0.07f);
    }
}

/* Six faces with six hues and six patterns. */
static vec3 faces(const ted4_ray_object *o, vec3 p, uint32_t seed)
{
    static const float hue[6][3] = { { .92f, .36f, .26f }, { .22f, .62f, .84f },
                                     { .96f, .80f, .24f }, { .36f, .74f, .40f },
                                     { .90f, .56f, .18f }, { .66f, .42f, .80f } };
    const vec3 q = v3(fabsf(p.x) / o->size.x, fabsf(p.y) / o->size.y, fabsf(p.z) / o->size.z);
    float u = p.x, v = p.z, side = p.y;
    int n = 2;

    if (q.x > q.y && q.x > q.z) {
        u = p.y;
        side = p.x;
        n = 0;
    } else if (q.z >= q.y) {
        v = p.y;
        side = p.z;
        n = 4;
    }
    n += side > 0;
    return v3_scale(v3_mix(ray_paint(hue[n][0], hue[n][1], hue[n][2]), o->colour[0],
                           face_pattern(n, u, v)),
                    grain(p, seed));
}

/* Eight sectors about z, and rings across them. */
static vec3 beach(const ted4_ray_object *o, vec3 p, uint32_t seed)
{
    const float turn = ted4_ray_atan2(p.y, p.x) / (float)(2 * RAY_PI);
    const float sector = bars(turn * length2(p.x, p.y), 0.125f * length2(p.x, p.y) + 1e-4f);
    const float ring = inside(fabsf(fabsf(p.z) - 0.13f) - 0.035f);
    const vec3 c = v3_mix(o->colour[0], o->colour[1], sector);

    return v3_scale(v3_mix(c, o->colour[2], ring), grain(p, seed));
}

/* For a bar: rings along it, a chequered stripe, and different hues on opposite faces. */
static vec3 ribbon(const ted4_ray_object *o, vec3 p, uint32_t seed)
{
    const int wide = fabsf(p.x) / o->size.x < fabsf(p.y) / o->size.y;
    const float across = wide ? p.x : p.y;
    const float c = exclusive(bars(p.z, 0.1f), bars(across, 0.1f));
    const float band = bars(p.z + 0.05f, 0.3f);
    const vec3 ground = v3_mix(o->colour[wide], ray_paint(.95f, .90f, .80f), band);

    return v3_scale(v3_mix(ground, o->colour[2], 0.85f * c), grain(p, seed));
}

/* Bricks (or planks) of width w and height h with joints of width gap. Sets *tone to a random value
 * per brick; returns 1 in a joint. */
static float courses(float u, float v, const float size[3], uint32_t seed, float *tone)
{
    const float w = size[0], h = size[1], gap = size[2];
    const int row = ray_floor(v / h);
    const float shift = u / w + 0.37f * (float)(row % 16) + 0.2f * ray_random(row, 0, 0, seed);
    const int column = ray_floor(shift);
    const float x = w * (shift - (float)column), y = v - h * (float)row;
    const float edge = ray_min(ray_min(x, w - x), ray_min(y, h - y));

    *tone = ray_random(row, column, 1, seed);
    return inside(edge - gap / 2);
}

static vec3 brick_wall(float u, float v, const vec3 colour[3], uint32_t seed)
{
    static const float size[3] = { 0.42f, 0.17f, 0.026f };
    const float rough = 0.75f + 0.3f * ted4_ray_noise2(u * 8, v * 8, seed + 5) +
                        0.2f * ted4_ray_noise2(u * 20, v * 20, seed + 6);
    float tone;
    const float joint = courses(u, v, size, seed, &tone);

    return v3_scale(v3_mix(v3_mix(colour[0], colour[1], tone), colour[2], joint), rough);
}

static vec3 brick(const ted4_ray_object *o, vec3 p, uint32_t seed)
{
    const vec3 q = v3(fabsf(p.x) / o->size.x, fabsf(p.y) / o->size.y, fabsf(p.z) / o->size.z);

    if (q.z > q.x && q.z > q.y)
        return v3_scale(o->colour[2], grain(p, seed));
    return brick_wall(q.x > q.y ? p.y : p.x, p.z + o->size.z, o->colour, seed);
}

vec3 ted4_ray_texture(const ted4_ray_object *o, vec3 p, uint32_t seed)
{
    switch (o->texture) {
    case RAY_FLAT: return o->colour[0];
    case RAY_WOOD: return wood(o, p, seed);
    case RAY_MARBLE: return marble(o, p, seed);
    case RAY_CHECKER: return checker(o, p, seed);
    case RAY_SPIRAL: return spiral(o, p, seed);
    case RAY_DOTS: return dots(o, p, seed);
    case RAY_FACES: return faces(o, p, seed);
    case RAY_BEACH: return beach(o, p, seed);
    case RAY_RIBBON: return ribbon(o, p, seed);
    case RAY_BRICK: return brick(o, p, seed);
    }
    return o->colour[0];
}

static vec3 planks(float x, float y, uint32_t seed)
{
    static const float size[3] = { 1.3f, 0.24f, 0.016f };
    float tone;
    const float joint = courses(x, y, size, seed, &tone);
    const float fibre = 0.6f * ted4_ray_noise2(x * 3, y * 22 + 40 * tone, seed + 1) +
                        0.4f * ted4_ray_noise2(x * 8 + 9 * tone, y * 44, seed + 2);
    const vec3 c = v3_mix(ray_paint(.66f, .52f, .40f), ray_paint(.84f, .70f, .53f), tone);

    return v3_mix(v3_scale(c, 0.74f + 0.45f * fibre), ray_paint(.22f, .15f, .11f), joint);
}

/* Vertical stripes with a lattice of diamonds. */
static vec3 wallpaper(float u, float v, vec3 a, vec3 b, vec3 c)
{
    const float x = 0.4f * ray_fract(u / 0.4f) - 0.2f;
    const float y = 0.36f * ray_fract(v / 0.36f) - 0.18f;
    const vec3 ground = v3_mix(a, b, bars(u, 0.2f));

    return v3_mix(ground, c, inside(fabsf(x) * 0.8f + fabsf(y) * 0.6f - 0.055f));
}

/* A framed picture with centre (cx, cz) and half size (hx, hz) on the wall: pattern n in a dark
 * frame. */
static vec3 picture(vec3 wall, const float place[4], float u, float v, int n)
{
    static const float ink[2][2][3] = { { { .12f, .30f, .52f }, { .96f, .88f, .62f } },
                                        { { .76f, .24f, .22f }, { .88f, .92f, .90f } } };
    const float x = u - place[0], y = v - place[1];
    const float d = ray_max(fabsf(x) - place[2], fabsf(y) - place[3]);
    const float r = length2(x, y), turn = ted4_ray_atan2(y, x) / (float)(2 * RAY_PI);
    const float sun = exclusive(bars(turn * r, r / 16 + 1e-4f), inside(r - 0.2f));
    const float zigzag = bars(y + 0.16f * fabsf(2 * ray_fract(x / 0.3f) - 1), 0.075f);
    const float mask = n == 0 ? sun : zigzag;
    const vec3 c = v3_mix(ray_paint(ink[n][0][0], ink[n][0][1], ink[n][0][2]),
                          ray_paint(ink[n][1][0], ink[n][1][1], ink[n][1][2]), mask);

    if (d > 0.08f)
        return wall;
    return v3_mix(v3_mix(wall, ray_paint(.20f, .13f, .10f), inside(d - 0.06f)), c, inside(d));
}

static vec3 back_wall(float u, float v, uint32_t seed)
{
    static const float left[4] = { -0.62f, 1.72f, 0.48f, 0.38f },
                       right[4] = { 0.85f, 1.82f, 0.42f, 0.5f };
    const vec3 colour[3] = { ray_paint(.62f, .34f, .27f), ray_paint(.80f, .55f, .42f),
                             ray_paint(.82f, .79f, .72f) };
    const vec3 wall = brick_wall(u, v, colour, seed);

    return picture(picture(wall, left, u, v, 0), right, u, v, 1);
}

vec3 ted4_ray_room_texture(ted4_ray_side side, vec3 p, uint32_t seed)
{
    const float mottle = 0.86f + 0.28f * ted4_ray_noise2(p.y * 6, p.z * 6 + p.x, seed + 9);

    switch (side) {
    case RAY_FLOOR: return planks(p.x, p.y, seed);
    case RAY_BACK: return back_wall(p.x, p.z, seed + 20);
    case RAY_LEFT:
        return v3_scale(wallpaper(p.y, p.z, ray_paint(.52f, .66f, .58f),
                                  ray_paint(.64f, .76f, .66f), ray_paint(.92f, .86f, .60f)),
                        mottle);
    case RAY_RIGHT:
        return v3_scale(wallpaper(p.y, p.z, ray_paint(.50f, .58f, .74f),
                                  ray_paint(.66f, .72f, .84f), ray_paint(.90f, .60f, .50f)),
                        mottle);
    case RAY_CEILING:
    case RAY_FRONT: break;
    }
    return v3_scale(ray_paint(.86f, .84f, .80f), mottle);
}
