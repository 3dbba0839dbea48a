/* test_scene_shapes.c - the scene maker: compares its sines and colours with libm, its rays and
 * shapes with brute force. Links tools/scene/ray_*.o.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <string.h>

#include "test.h"
#include "random_source.h"
#include "tools/scene/ray_set.h"

static vec3 in_cube(random_source *r, float half)
{
    const float x = random_float(r, -half, half), y = random_float(r, -half, half);

    return v3(x, y, random_float(r, -half, half));
}

/* ---- arithmetic against libm ---- */

static void test_math(void **state)
{
    (void)state;
    for (int i = -2000; i <= 2000; i++) {
        const double t = i / 811.0;
        assert_true(fabs(ted4_ray_sin(t) - sin(2 * RAY_PI * t)) < 1e-14);
        assert_true(fabs(ted4_ray_cos(t) - cos(2 * RAY_PI * t)) < 1e-14);
        const float y = (float)sin(t * 3), x = (float)cos(t * 3);
        assert_true(fabsf(ted4_ray_atan2(y, x) - atan2f(y, x)) < 1e-6f);
    }
    for (int i = 0; i <= 1000; i++) {
        const double x = i / 1000.0;
        const double y = x <= 0.0031308 ? 12.92 * x : 1.055 * pow(x, 1 / 2.4) - 0.055;
        assert_true(fabs(ted4_ray_srgb((float)x) - 255 * y) < 0.51);
    }
    assert_int_equal(ted4_ray_srgb(-1), 0);
    assert_int_equal(ted4_ray_srgb(7), 255);
    assert_int_equal(ray_floor(-0.5f), -1);
    assert_int_equal(ray_floor(3), 3);
}

/* ---- shapes ---- */

/* One solid of each kind, rotated and away from the origin. */
static ted4_ray_object askew(int kind)
{
    static const float rot[9] = { 0.36f, 0.48f, -0.8f, -0.8f, 0.6f, 0, 0.48f, 0.64f, 0.6f };
    ted4_ray_object o = { .kind = (ted4_ray_kind)kind,
                          .size = v3(0.5f, 0.3f, 0.7f),
                          .pos = v3(0.3f, -0.2f, 0.1f) };

    memcpy(o.rot, rot, sizeof rot);
    if (o.kind == RAY_BAR) {
        o.size = v3(0.2f, 0.17f, 1.4f);
        o.bend = -0.8f;
        o.twist = 0.15f;
    }
    ted4_ray_bound(&o);
    return o;
}

/* Written from the definitions in ray_shape.h. The bar's edges have a radius of 0.02. */
static int is_inside(const ted4_ray_object *o, vec3 point)
{
    const vec3 p = ray_unrotate(o->rot, v3_sub(point, o->pos)), s = o->size;
    vec3 q;

    switch (o->kind) {
    case RAY_SPHERE: return v3_length(p) < s.x;
    case RAY_BOX: return fabsf(p.x) < s.x && fabsf(p.y) < s.y && fabsf(p.z) < s.z;
    case RAY_CYLINDER: return sqrtf(p.x * p.x + p.y * p.y) < s.x && fabsf(p.z) < s.z;
    case RAY_BAR: break;
    }
    q = ted4_ray_unbend(o, p);
    q = v3(fabsf(q.x) - s.x + 0.02f, fabsf(q.y) - s.y + 0.02f,
           fabsf(q.z - s.z / 2) - s.z / 2 + 0.02f);
    return v3_length(v3(ray_max(q.x, 0), ray_max(q.y, 0), ray_max(q.z, 0))) < 0.02f;
}

/* Returns the distance at which inside first changes along the ray, found by small steps, or
 * far. */
static float brute_meet(const ted4_ray_object *o, vec3 from, vec3 d, float far)
{
    const float step = 0.002f;
    const int start = is_inside(o, from);

    for (float t = step; t < far; t += step) {
        if (is_inside(o, v3_along(from, d, t)) != start)
            return t;
    }
    return far;
}

/* Rays that pass an edge at less than one step may be found by one method only: a few in a
 * thousand. */
static void test_shapes(void **state)
{
    random_source source = random_seed(1);

    (void)state;
    for (int kind = RAY_SPHERE; kind <= RAY_BAR; kind++) {
        const ted4_ray_object o = askew(kind);
        int hits = 0, wrong = 0;

        for (int i = 0; i < 600; i++) {
            const vec3 from = v3_add(o.centre, v3_scale(v3_unit(in_cube(&source, 1)), 2));
            const vec3 d = v3_unit(v3_sub(v3_add(o.centre, in_cube(&source, 0.7f)), from));
            const float t = ted4_ray_meet(&o, from, d, 0, 4), b = brute_meet(&o, from, d, 4);

            hits += b < 4;
            wrong += !(fabsf(t - b) <= 0.004f);
        }
        assert_true(hits > 100);
        assert_true(hits < 590);
        assert_true(wrong <= 4);
    }
}

/* The point found lies on the boundary, its normal points outwards, and both are in the bounding
 * sphere. */
static void test_surfaces(void **state)
{
    random_source source = random_seed(7);

    (void)state;
    for (int kind = RAY_SPHERE; kind <= RAY_BAR; kind++) {
        const ted4_ray_object o = askew(kind);
        int hits = 0, wrong = 0;

        for (int i = 0; i < 1000; i++) {
            const vec3 from = v3_add(o.centre, v3_scale(v3_unit(in_cube(&source, 1)), 2));
            const vec3 d = v3_unit(v3_sub(v3_add(o.centre, in_cube(&source, 0.6f)), from));
            const float t = ted4_ray_meet(&o, from, d, 0, 4);
            if (t == 4)
                continue;
            const vec3 p = v3_along(from, d, t);
            const ted4_ray_surface s = ted4_ray_surface_at(&o, p);
            hits++;
            wrong += !is_inside(&o, v3_along(p, s.normal, -0.003f)) ||
                     is_inside(&o, v3_along(p, s.normal, 0.003f));
            assert_true(fabsf(v3_length(s.normal) - 1) < 1e-4f);
            assert_true(v3_dot(s.normal, d) < 0.2f);
            assert_true(v3_length(v3_sub(p, o.centre)) < o.reach * 1.001f);
        }
        assert_true(hits > 200);
        assert_true(wrong <= hits / 50);
    }
}

static void test_shape_values(void **state)
{
    ted4_ray_object o = { .kind = RAY_SPHERE,
                          .size = v3(0.5f, 0.5f, 0.5f),
                          .pos = v3(0, 0, 1),
                          .rot = { 1, 0, 0, 0, 1, 0, 0, 0, 1 } };
    const vec3 down = v3(0, 0, -1);

    (void)state;
    ted4_ray_bound(&o);
    assert_true(fabsf(ted4_ray_meet(&o, v3(0, 0, 4), down, 0, 9) - 2.5f) < 1e-6f);
    assert_true(fabsf(ted4_ray_meet(&o, v3(0, 0, 1), down, 0, 9) - 0.5f) < 1e-6f);
    assert_true(ted4_ray_meet(&o, v3(0, 0, 4), down, 0, 2) == 2);
    assert_true(ted4_ray_meet(&o, v3(0, 0, 4), down, 3.6f, 9) == 9);
    assert_true(ted4_ray_meet(&o, v3(0.6f, 0, 4), down, 0, 9) == 9);
    o.kind = RAY_CYLINDER;
    assert_true(fabsf(ted4_ray_meet(&o, v3(0.4f, 0, 4), down, 0, 9) - 2.5f) < 1e-6f);
    assert_true(fabsf(ted4_ray_meet(&o, v3(-3, 0, 1), v3(1, 0, 0), 0, 9) - 2.5f) < 1e-6f);
    assert_true(ted4_ray_meet(&o, v3(0.6f, 0, 4), down, 0, 9) == 9);
    o.kind = RAY_BOX;
    assert_true(fabsf(ted4_ray_meet(&o, v3(0.4f, -0.4f, 4), down, 0, 9) - 2.5f) < 1e-6f);
    assert_true(ted4_ray_meet(&o, v3(0.6f, 0.4f, 4), down, 0, 9) == 9);
}

/* unbend undoes rebend; the axis keeps its length and ends where a circle's arc does, turned by the
 * twist. */
static void test_bar(void **state)
{
    const ted4_ray_object o = askew(RAY_BAR);
    random_source source = random_seed(3);
    double length = 0;

    (void)state;
    for (int i = 0; i < 500; i++) {
        const vec3 q = v3(random_float(&source, -.2f, .2f), random_float(&source, -.2f, .2f),
                          random_float(&source, -.1f, 1.5f));
        assert_true(v3_length(v3_sub(ted4_ray_unbend(&o, ted4_ray_rebend(&o, q)), q)) < 1e-5f);
    }
    for (int i = 0; i < 100; i++)
        length += (double)v3_length(v3_sub(ted4_ray_rebend(&o, v3(0, 0, 0.014f * (float)(i + 1))),
                                           ted4_ray_rebend(&o, v3(0, 0, 0.014f * (float)i))));
    assert_true(fabs(length - 1.4) < 1e-3);
    const vec3 tip = ted4_ray_rebend(&o, v3(0, 0, 1.4f));
    assert_true(fabs((double)tip.x - (1 - cos(0.8 * 1.4)) / -0.8) < 1e-5);
    assert_true(fabs((double)tip.z - sin(0.8 * 1.4) / 0.8) < 1e-5);
    const vec3 corner = ted4_ray_rebend(&o, v3(0.1f, 0, 1.4f));
    assert_true(fabs((double)corner.y - 0.1 * sin(2 * RAY_PI * 0.15 * 1.4)) < 1e-6);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_math),     cmocka_unit_test(test_shapes),
        cmocka_unit_test(test_surfaces), cmocka_unit_test(test_shape_values),
        cmocka_unit_test(test_bar),
    };

    return cmocka_run_group_tests_name("shapes of scenes", tests, NULL, NULL);
}
