/* ray_render.c - renders with one ray per sample, an area light and ambient light; 3 x 3 stratified
 * samples, without randomness. Solids are culled by their bounding spheres: once per picture for
 * camera rays, and once per small patch of surface against the cone to the lamp.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "ray_render.h"

#include <stddef.h>

#include "ray_texture.h"

/* Samples per pixel side, and cells per lamp side: each sample of a pixel tests another cell of the
 * lamp. */
enum { SIDE = 3 };
static const float near_plane = 0.05f, lift = 0.003f, patch = 0.1f;
enum { NOTHING = -2, ROOM = -1 };

/* Half-open rectangle of the pixels in which an object may be visible. */
typedef struct {
    int x0, x1, y0, y1;
} window;

/* Objects that a ray may hit. */
typedef struct {
    int n, id[TED4_RAY_MAX_OBJECTS];
} crowd;

typedef struct {
    const ted4_ray_world *w;
    const ted4_ray_camera *c;
    vec3 eye;
    float axis[9];     /* the right, up and backward axes of the camera as rows */
    float light_reach; /* radius of a sphere around the lamp */
    window shows[TED4_RAY_MAX_OBJECTS];
    crowd shade; /* objects that may hide the lamp within patch of shade_at on shade_of */
    vec3 shade_at;
    int shade_of;
} view;

/* A sample of a pixel: its direction, and its place (i, j) in the 3 x 3 grid. */
typedef struct {
    vec3 d;
    int i, j;
} sample;

/* What a ray has hit. */
typedef struct {
    ted4_ray_surface surface;
    vec3 albedo;
    float gloss;
} matter;

/* Computes the range of pixels that a sphere covers along one axis, from the tangents of the two
 * lines of sight that touch the sphere in that plane. */
static void sphere_range(double x, double z, double r, const double scale_middle[2], int limit,
                         int range[2])
{
    const double q = z * z - r * r, root = r * sqrt(x * x + z * z - r * r + 1e-12);
    double a, b;

    range[0] = 0;
    range[1] = limit;
    if (z <= r + 0.01)
        return;
    a = scale_middle[1] + scale_middle[0] * (x * z - root) / q - 1;
    b = scale_middle[1] + scale_middle[0] * (x * z + root) / q + 2;
    range[0] = a <= 0 ? 0 : a >= limit ? limit : (int)a;
    range[1] = b <= 0 ? 0 : b >= limit ? limit : (int)b;
}

static window window_of(const view *v, const ted4_ray_object *o)
{
    const vec3 p = ray_unrotate(v->axis, v3_sub(o->centre, v->eye));
    const double x[2] = { v->c->focal, v->c->cx }, y[2] = { v->c->focal, v->c->cy };
    int across[2], down[2];

    sphere_range((double)p.x, (double)-p.z, (double)o->reach, x, v->c->width, across);
    sphere_range((double)-p.y, (double)-p.z, (double)o->reach, y, v->c->height, down);
    return (window) { across[0], across[1], down[0], down[1] };
}

static view view_of(const ted4_ray_world *w, const ted4_ray_camera *c)
{
    view v = { .w = w, .c = c, .shade_of = NOTHING };

    v.eye = v3((float)c->matrix[0][3], (float)c->matrix[1][3], (float)c->matrix[2][3]);
    for (int i = 0; i < 9; i++)
        v.axis[i] = (float)c->matrix[i / 3][i % 3];
    v.light_reach = v3_length(w->lamp_x) + v3_length(w->lamp_y);
    for (int i = 0; i < w->n; i++)
        v.shows[i] = window_of(&v, &w->object[i]);
    return v;
}

static crowd showing(const view *v, int x, int y)
{
    crowd c = { 0 };

    for (int i = 0; i < v->w->n; i++) {
        const window s = v->shows[i];
        if (x >= s.x0 && x < s.x1 && y >= s.y0 && y < s.y1)
            c.id[c.n++] = i;
    }
    return c;
}

/* Fills v->shade for the surroundings of p on an object, by testing bounding spheres against the
 * cone from there to the lamp's bounding sphere. A convex object does not hide the lamp from any
 * lit point of itself. */
static void find_shade(view *v, vec3 p, int object)
{
    const vec3 to = v3_sub(v->w->lamp, p);
    const float span = v3_dot(to, to);

    v->shade_at = p;
    v->shade_of = object;
    v->shade.n = 0;
    for (int i = 0; i < v->w->n; i++) {
        const ted4_ray_object *const o = &v->w->object[i];
        const vec3 at = v3_sub(o->centre, p);
        const float t = ray_clamp(v3_dot(at, to) / span, 0, 1);
        const float r = o->reach + patch + t * v->light_reach;
        const vec3 off = v3_along(at, to, -t);
        if (v3_dot(off, off) < r * r && (i != object || o->kind == RAY_BAR))
            v->shade.id[v->shade.n++] = i;
    }
}

static int meets_any(const ted4_ray_world *w, const crowd *c, vec3 from, vec3 d, float far)
{
    for (int i = 0; i < c->n; i++) {
        if (ted4_ray_meet(&w->object[c->id[i]], from, d, 0, far) < far)
            return 1;
    }
    return 0;
}

/* Returns 1 if a sample sees its cell of the lamp from p on an object. The cells (i + j, i + 2 j)
 * modulo 3 are a permutation, so that the place in the pixel and the place on the lamp have no
 * direction in common. */
static int sees_lamp(view *v, const sample *k, vec3 p, int object)
{
    const int a = (k->i + k->j) % SIDE, b = (k->i + 2 * k->j) % SIDE;
    const float s = (2 * (float)a + 1) / SIDE - 1, t = (2 * (float)b + 1) / SIDE - 1;
    const vec3 lamp = v3_along(v3_along(v->w->lamp, v->w->lamp_x, s), v->w->lamp_y, t);
    const vec3 to = v3_sub(lamp, p), moved = v3_sub(p, v->shade_at);
    const float far = v3_length(to);

    if (object != v->shade_of || v3_dot(moved, moved) > patch * patch)
        find_shade(v, p, object);
    return !meets_any(v->w, &v->shade, p, v3_scale(to, 1 / far), far);
}

/* Returns the reflected light: ambient light from above, a weak light without shadow from the side
 * of the cameras, the lamp, and a broad highlight of the lamp. */
static vec3 lit(view *v, const sample *k, const ted4_ray_sight *r, const matter *m)
{
    const vec3 fill = v3(0.39f, -0.86f, 0.33f), warm = v3(1.0f, 0.96f, 0.90f),
               sky = v3(0.94f, 0.97f, 1.0f);
    const vec3 to = v3_sub(v->w->lamp, r->point), normal = m->surface.normal;
    const float d2 = v3_dot(to, to), cosine = v3_dot(normal, to) / sqrtf(d2);
    const float ambient = 0.12f + 0.05f * normal.z + 0.13f * ray_max(0, v3_dot(normal, fill));
    float direct = 0, shine = 0;

    if (cosine > 0 && sees_lamp(v, k, v3_along(r->point, normal, lift), r->object)) {
        const vec3 half = v3_unit(v3_sub(v3_scale(to, 1 / sqrtf(d2)), k->d));
        float h = ray_max(0, v3_dot(half, normal));
        for (int i = 0; i < 5; i++)
            h *= h;
        direct = cosine * v->w->lamp_power / (d2 + 3);
        shine = m->gloss * h;
    }
    return v3_add(v3_mul(m->albedo, v3_add(v3_scale(warm, direct), v3_scale(sky, ambient))),
                  v3(shine, shine, shine));
}

/* The room is convex and contains the eye, so the nearest of the three planes ahead is hit. */
static float room_meet(const ted4_ray_world *w, vec3 from, vec3 d, ted4_ray_side *side,
                       vec3 *normal)
{
    const float tx = ((d.x > 0 ? w->room_high.x : w->room_low.x) - from.x) / d.x;
    const float ty = ((d.y > 0 ? w->room_high.y : w->room_low.y) - from.y) / d.y;
    const float tz = ((d.z > 0 ? w->room_high.z : w->room_low.z) - from.z) / d.z;
    float t = INFINITY;

    if (d.x != 0) {
        t = tx;
        *side = d.x > 0 ? RAY_RIGHT : RAY_LEFT;
        *normal = v3(d.x > 0 ? -1.0f : 1.0f, 0, 0);
    }
    if (d.y != 0 && ty < t) {
        t = ty;
        *side = d.y > 0 ? RAY_BACK : RAY_FRONT;
        *normal = v3(0, d.y > 0 ? -1.0f : 1.0f, 0);
    }
    if (d.z != 0 && tz < t) {
        t = tz;
        *side = d.z > 0 ? RAY_CEILING : RAY_FLOOR;
        *normal = v3(0, 0, d.z > 0 ? -1.0f : 1.0f);
    }
    return t;
}

static vec3 room_albedo(const ted4_ray_world *w, ted4_ray_side side, vec3 p)
{
    if (w->room == RAY_PLAIN && side != RAY_FLOOR)
        return ray_paint(.74f, .72f, .68f);
    return ted4_ray_room_texture(side, p, w->seed);
}

/* Returns what a sample sees: the nearest of the objects in c, or the room. */
static ted4_ray_sight sight(view *v, const crowd *c, const sample *k)
{
    ted4_ray_side side = RAY_FLOOR;
    ted4_ray_sight r = { .object = ROOM };
    matter m = { 0 };
    float t = INFINITY;

    if (v->w->room != RAY_DARK)
        t = room_meet(v->w, v->eye, k->d, &side, &m.surface.normal);
    for (int i = 0; i < c->n; i++) {
        const float far = t;
        t = ted4_ray_meet(&v->w->object[c->id[i]], v->eye, k->d, near_plane, far);
        if (t < far)
            r.object = c->id[i];
    }
    r.depth = t;
    if (t == INFINITY) {
        r.object = NOTHING;
        return r;
    }
    r.point = v3_along(v->eye, k->d, t);
    if (r.object != ROOM) {
        const ted4_ray_object *const o = &v->w->object[r.object];
        m.surface = ted4_ray_surface_at(o, r.point);
        m.albedo = ted4_ray_texture(o, v3_add(m.surface.material, o->skin),
                                    v->w->seed + 31u * (uint32_t)o->texture);
        m.gloss = o->gloss;
    } else {
        m.albedo = room_albedo(v->w, side, r.point);
    }
    r.colour = lit(v, k, &r, &m);
    return r;
}

static vec3 direction(const view *v, double px, double py)
{
    const vec3 d =
        v3((float)((px - v->c->cx) / v->c->focal), (float)((v->c->cy - py) / v->c->focal), -1);

    return ray_rotate(v->axis, v3_unit(d));
}

/* Returns the sum of the samples of a pixel. Sets *hits to the number of samples that hit
 * something. */
static vec3 samples(view *v, int x, int y, int *hits)
{
    const crowd c = showing(v, x, y);
    vec3 sum = v3(0, 0, 0);

    *hits = 0;
    for (int n = 0; n < SIDE * SIDE; n++) {
        const int i = n % SIDE, j = n / SIDE;
        const sample k = { direction(v, x + (i + 0.5) / SIDE, y + (j + 0.5) / SIDE), i, j };
        const ted4_ray_sight r = sight(v, &c, &k);
        const vec3 s = ray_rotate(v->c->colour, r.colour);
        sum = v3_add(sum, v3(ray_clamp(s.x, 0, 1), ray_clamp(s.y, 0, 1), ray_clamp(s.z, 0, 1)));
        *hits += r.object != NOTHING;
    }
    return sum;
}

void ted4_ray_render(const ted4_ray_world *w, const ted4_ray_camera *c, uint8_t *rgb)
{
    view v = view_of(w, c);
    int hits;

    for (int y = 0; y < c->height; y++) {
        for (int x = 0; x < c->width; x++)
            ted4_ray_bytes(v3_scale(samples(&v, x, y, &hits), 1.0f / (SIDE * SIDE)),
                           rgb + 3 * ((size_t)y * (size_t)c->width + (size_t)x));
    }
}

void ted4_ray_cut_out(const ted4_ray_world *w, const ted4_ray_camera *c, uint8_t *rgba)
{
    view v = view_of(w, c);
    int hits;

    for (int y = 0; y < c->height; y++) {
        for (int x = 0; x < c->width; x++) {
            uint8_t *const p = rgba + 4 * ((size_t)y * (size_t)c->width + (size_t)x);
            const vec3 sum = samples(&v, x, y, &hits);

            ted4_ray_bytes(v3_scale(sum, 1.0f / (float)(hits > 0 ? hits : 1)), p);
            p[3] = (uint8_t)((255 * hits + SIDE * SIDE / 2) / (SIDE * SIDE));
        }
    }
}

ted4_ray_sight ted4_ray_look(const ted4_ray_world *w, const ted4_ray_camera *c, double px,
                             double py)
{
    view v = view_of(w, c);
    const crowd around = showing(&v, ray_floor((float)px), ray_floor((float)py));
    sample k = { direction(&v, px, py), 0, 0 };
    ted4_ray_sight r = { 0 };
    vec3 sum = v3(0, 0, 0);

    for (k.i = 0; k.i < SIDE; k.i++) {
        for (k.j = 0; k.j < SIDE; k.j++) {
            r = sight(&v, &around, &k);
            sum = v3_add(sum, r.colour);
        }
    }
    r.colour = v3_scale(sum, 1.0f / (SIDE * SIDE));
    return r;
}
