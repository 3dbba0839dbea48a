/* ray_shape.c - ray intersections: sphere, box and cylinder in closed form, the bent bar by
 * stepping along its distance function.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "ray_shape.h"

/* BAR_ROUND: radius of the bar's edges. BAR_NEAR: a point this close to the surface counts as a
 * hit. */
#define BAR_ROUND  0.02f
#define BAR_NEAR   0.0006f
/* Bending and twisting stretch space by less than 1 / 0.62 for |bend| size.x < 0.2 and |twist|
 * size.x < 0.05 (test_scene checks). */
#define BAR_STRIDE 0.62f
#define BAR_LEAVE  2.5f
#define BAR_STEPS  160
#define BEND_LEAST 1e-5f

static float sphere_meet(float r, vec3 o, vec3 d, float near, float far)
{
    const float b = v3_dot(o, d), c = v3_dot(o, o) - r * r, q = b * b - c;
    float root, t;

    if (q <= 0)
        return far;
    root = sqrtf(q);
    t = -b - root;
    if (t <= near)
        t = -b + root;
    return t > near && t < far ? t : far;
}

static void swap_if(float *a, float *b)
{
    if (*a > *b) {
        const float t = *a;
        *a = *b;
        *b = t;
    }
}

/* Intersects [*in, *out] with the interval of t in which the ray is between two parallel planes. A
 * ray that lies inside and parallel to them changes nothing. */
static void slab(float low, float high, float o, float d, float *in, float *out)
{
    const float inverse = 1 / d;
    float a = (low - o) * inverse, b = (high - o) * inverse;

    if (d == 0) {
        if (o < low || o > high)
            *in = INFINITY;
        return;
    }
    swap_if(&a, &b);
    *in = ray_max(*in, a);
    *out = ray_min(*out, b);
}

static void box_span(vec3 low, vec3 high, vec3 o, vec3 d, float *in, float *out)
{
    slab(low.x, high.x, o.x, d.x, in, out);
    slab(low.y, high.y, o.y, d.y, in, out);
    slab(low.z, high.z, o.z, d.z, in, out);
}

/* Returns the first end of the interval [in, out] that lies in (near, far), or far. The ray is
 * inside the convex solid in [in, out]. */
static float entry(float in, float out, float near, float far)
{
    float t = far;

    if (in <= out && in > near)
        t = in;
    else if (in <= out && out > near)
        t = out;
    return t < far ? t : far;
}

static float box_meet(vec3 h, vec3 o, vec3 d, float near, float far)
{
    float in = -INFINITY, out = INFINITY;

    box_span(v3_scale(h, -1), h, o, d, &in, &out);
    return entry(in, out, near, far);
}

static float cylinder_meet(vec3 size, vec3 o, vec3 d, float near, float far)
{
    const float a = d.x * d.x + d.y * d.y, b = o.x * d.x + o.y * d.y;
    const float c = o.x * o.x + o.y * o.y - size.x * size.x, q = b * b - a * c;
    float in = -INFINITY, out = INFINITY;

    if (a == 0 ? c > 0 : q <= 0)
        return far;
    if (a > 0) {
        const float root = sqrtf(q);
        in = (-b - root) / a;
        out = (-b + root) / a;
    }
    slab(-size.z, size.z, o.z, d.z, &in, &out);
    return entry(in, out, near, far);
}

static float bend_of(const ted4_ray_object *o)
{
    if (fabsf(o->bend) < BEND_LEAST)
        return BEND_LEAST;
    return o->bend;
}

/* Position of a point relative to the axis of a bar. With k the curvature, the axis is the circle
 * around (1/k, 0) in the xz plane; a = 1 - k x and b = k z are coordinates relative to its centre
 * in radii, and h is their length. u = (1 - h) / k, computed without cancellation, is the distance
 * inwards from the axis within the plane. */
typedef struct {
    float k, a, b, h, u;
} arc;

static arc arc_at(const ted4_ray_object *o, vec3 p)
{
    arc r = { .k = bend_of(o) };

    r.a = 1 - r.k * p.x;
    r.b = r.k * p.z;
    r.h = sqrtf(r.a * r.a + r.b * r.b);
    r.u = (2 * p.x - r.k * (p.x * p.x + p.z * p.z)) / (1 + r.h);
    return r;
}

/* Returns the angle of (a, b) divided by k. The angle is 2 atan(b / (a + h)), valid up to 130
 * degrees; the bar ends before that. */
static float arc_length(const arc *r)
{
    const float half = ray_atan(ray_min(fabsf(r->b) / (r->a + r->h), 2));

    return 2 * (r->b < 0 ? -half : half) / r->k;
}

/* Sine and cosine of the twist at arc length s, which is less than a quarter turn either way: a
 * series up to x^11, whose first omitted term is 6e-8. */
static void twist_at(const ted4_ray_object *o, float s, float sine_cosine[2])
{
    const float x = (float)(2 * RAY_PI) * o->twist * ray_clamp(s, 0, o->size.z), y = x * x;
    const float sine =
        x *
        (1 - y * (1.0f / 6) *
                 (1 - y * (1.0f / 20) *
                          (1 - y * (1.0f / 42) * (1 - y * (1.0f / 72) * (1 - y * (1.0f / 110))))));

    sine_cosine[0] = sine;
    sine_cosine[1] = sqrtf(ray_max(0, 1 - sine * sine));
}

static vec3 straight(const ted4_ray_object *o, const arc *r, float y)
{
    const float s = arc_length(r);
    float t[2];

    twist_at(o, s, t);
    return v3(t[1] * r->u + t[0] * y, t[1] * y - t[0] * r->u, s);
}

vec3 ted4_ray_unbend(const ted4_ray_object *o, vec3 local)
{
    const arc r = arc_at(o, local);

    return straight(o, &r, local.y);
}

vec3 ted4_ray_rebend(const ted4_ray_object *o, vec3 q)
{
    const double k = (double)bend_of(o), turns = k * (double)q.z / (2 * RAY_PI);
    float t[2];

    twist_at(o, q.z, t);
    const double h = 1 - k * (double)(t[1] * q.x - t[0] * q.y);
    return v3((float)((1 - h * ted4_ray_cos(turns)) / k), t[0] * q.x + t[1] * q.y,
              (float)(h * ted4_ray_sin(turns) / k));
}

/* Distance to a rounded box, for a point in straight coordinates whose second coordinate is y0. */
static float bar_distance(const ted4_ray_object *o, const arc *r, float y0)
{
    const vec3 q = straight(o, r, y0);
    const float x = fabsf(q.x) - o->size.x + BAR_ROUND, y = fabsf(q.y) - o->size.y + BAR_ROUND;
    const float z = fabsf(q.z - o->size.z / 2) - o->size.z / 2 + BAR_ROUND;
    const vec3 out = v3(ray_max(x, 0), ray_max(y, 0), ray_max(z, 0));

    return v3_length(out) + ray_min(ray_max(x, ray_max(y, z)), 0) - BAR_ROUND;
}

static float hull_radius(const ted4_ray_object *o)
{
    return sqrtf(o->size.x * o->size.x + o->size.y * o->size.y);
}

/* Returns the length of the next step at distance r, after a step of length last from distance
 * before (0: unknown). The distance along a ray is nearly convex inside the hull, as it is for an
 * unbent bar. So while it falls, the line through the last two values reaches zero before the
 * surface does. If it rises, the ray is leaving the surface, and the step may be longer. */
static float bar_step(float r, float before, float last, float hull)
{
    if (before > r)
        return ray_max(BAR_STRIDE * r, ray_min(r * last / (before - r), hull / 2));
    return r * (before > 0 ? BAR_LEAVE : BAR_STRIDE);
}

/* Outside the round hull, the distance to the ring that contains the hull is exact and cheap, as it
 * needs neither arc length nor twist. Inside, the distance to the bar itself is used. */
static float bar_meet(const ted4_ray_object *o, vec3 p, vec3 d, float near, float far)
{
    const float hull = hull_radius(o);
    float in = near, out = far, before = 0, step = 0;

    box_span(o->low, o->high, p, d, &in, &out);
    for (int i = 0; i < BAR_STEPS && in < out; i++) {
        const vec3 at = v3_along(p, d, in);
        const arc a = arc_at(o, at);
        float r = sqrtf(a.u * a.u + at.y * at.y) - hull;
        if (r >= BAR_ROUND) {
            before = 0;
            step = r;
        } else {
            r = bar_distance(o, &a, at.y);
            if (r < BAR_NEAR && before > r)
                in += r * step / (before - r);
            if (r < BAR_NEAR)
                return in > near && in < far ? in : far;
            step = bar_step(r, before, step, hull);
            before = r;
        }
        in += step;
    }
    return far;
}

/* Sets the box around two curves on the hull, to the left and right of the axis in its plane;
 * across that plane the hull's radius is enough. The margin exceeds the distance between a curve
 * and the chord of two successive points on it. */
static void bar_bound(ted4_ray_object *o)
{
    const float r = hull_radius(o), margin = 0.01f;
    const int steps = 16;

    o->low = v3(INFINITY, -r, INFINITY);
    o->high = v3(-INFINITY, r, -INFINITY);
    for (int i = 0; i <= 2 * steps + 1; i++) {
        ted4_ray_object plain = *o;
        plain.twist = 0;
        const vec3 p = ted4_ray_rebend(&plain, v3(i % 2 ? r : -r, 0,
                                                  o->size.z * (float)(i / 2) / (float)steps));
        o->low = v3(ray_min(o->low.x, p.x - margin), -r, ray_min(o->low.z, p.z - margin));
        o->high = v3(ray_max(o->high.x, p.x + margin), r, ray_max(o->high.z, p.z + margin));
    }
}

void ted4_ray_bound(ted4_ray_object *o)
{
    vec3 middle = v3(0, 0, 0);

    switch (o->kind) {
    case RAY_SPHERE: o->reach = o->size.x; break;
    case RAY_BOX: o->reach = v3_length(o->size); break;
    case RAY_CYLINDER: o->reach = v3_length(v3(o->size.x, 0, o->size.z)); break;
    case RAY_BAR:
        bar_bound(o);
        middle = v3_scale(v3_add(o->low, o->high), 0.5f);
        o->reach = v3_length(v3_sub(o->high, middle));
        break;
    }
    o->centre = v3_add(ray_rotate(o->rot, middle), o->pos);
}

float ted4_ray_meet(const ted4_ray_object *o, vec3 from, vec3 d, float near, float far)
{
    const vec3 p = ray_unrotate(o->rot, v3_sub(from, o->pos)), e = ray_unrotate(o->rot, d);

    switch (o->kind) {
    case RAY_SPHERE: return sphere_meet(o->size.x, p, e, near, far);
    case RAY_BOX: return box_meet(o->size, p, e, near, far);
    case RAY_CYLINDER: return cylinder_meet(o->size, p, e, near, far);
    case RAY_BAR: return bar_meet(o, p, e, near, far);
    }
    return far;
}

static float sign_of(float x)
{
    return x < 0 ? -1.0f : 1.0f;
}

static vec3 box_normal(vec3 h, vec3 p)
{
    const vec3 q = v3(fabsf(p.x) / h.x, fabsf(p.y) / h.y, fabsf(p.z) / h.z);

    if (q.x > q.y && q.x > q.z)
        return v3(sign_of(p.x), 0, 0);
    return q.y > q.z ? v3(0, sign_of(p.y), 0) : v3(0, 0, sign_of(p.z));
}

static vec3 cylinder_normal(vec3 size, vec3 p)
{
    const float r = sqrtf(p.x * p.x + p.y * p.y);

    if (r == 0 || fabsf(p.z) / size.z > r / size.x)
        return v3(0, 0, sign_of(p.z));
    return v3(p.x / r, p.y / r, 0);
}

/* Computes the gradient of the distance from its values at the corners of a small tetrahedron. */
static vec3 bar_normal(const ted4_ray_object *o, vec3 p)
{
    static const float corner[4][3] = { { 1, 1, 1 }, { 1, -1, -1 }, { -1, 1, -1 }, { -1, -1, 1 } };
    vec3 g = v3(0, 0, 0);

    for (int i = 0; i < 4; i++) {
        const vec3 e = v3(corner[i][0], corner[i][1], corner[i][2]);
        const vec3 at = v3_along(p, e, 0.001f);
        const arc a = arc_at(o, at);
        g = v3_along(g, e, bar_distance(o, &a, at.y));
    }
    return v3_unit(g);
}

ted4_ray_surface ted4_ray_surface_at(const ted4_ray_object *o, vec3 point)
{
    const vec3 p = ray_unrotate(o->rot, v3_sub(point, o->pos));
    ted4_ray_surface s = { v3(0, 0, 1), p };

    switch (o->kind) {
    case RAY_SPHERE: s.normal = v3_unit(p); break;
    case RAY_BOX: s.normal = box_normal(o->size, p); break;
    case RAY_CYLINDER: s.normal = cylinder_normal(o->size, p); break;
    case RAY_BAR:
        s.normal = bar_normal(o, p);
        s.material = ted4_ray_unbend(o, p);
        break;
    }
    s.normal = ray_rotate(o->rot, s.normal);
    return s;
}
