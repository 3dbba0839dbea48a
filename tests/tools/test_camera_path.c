/* test_camera_path.c - tool/camera_path.h: a path passes through its keys and turns evenly between
 * them; an orbit looks at its centre, upright, from its circle; what cameras look at is found.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <math.h>
#include <string.h>

#include "test.h"
#include "tool/camera_path.h"
#include "tool/rotation.h"

enum { KEYS = 3 };

static const double TURN = 6.283185307179586;

/* A camera turned by angle about y, with its centre at (x, 0, 0). */
static ted4_listed_camera key(double angle, double x, int width)
{
    const float c = (float)cos(angle), s = (float)sin(angle);
    ted4_listed_camera k = { .view = { .width = width,
                                       .height = 60,
                                       .fx = (float)width,
                                       .fy = 70,
                                       .cx = (float)width / 2,
                                       .cy = 30,
                                       .R = { c, 0, s, 0, 1, 0, -s, 0, c } } };

    for (int r = 0; r < 3; r++)
        k.view.t[r] = -k.view.R[3 * r] * (float)x;
    return k;
}

static void near(double got, double want, double within)
{
    if (!(fabs(got - want) <= within))
        fail_msg("%.9g, expected %.9g", got, want);
}

static void test_between(void **state)
{
    ted4_listed_camera keys[KEYS] = { key(0.0, 0.0, 80), key(TURN / 4, 1.0, 40),
                                      key(TURN / 2, 2.0, 80) };
    const ted4_camera_list l = { .camera = keys, .n = KEYS };
    ted4_view v[5];
    double centre[3];

    (void)state;
    ted4_path_between(&l, 5, v);
    for (int i = 0; i < 5; i++) {
        const ted4_listed_camera want = key(TURN / 8 * i, 0.5 * i, 80);

        assert_int_equal(v[i].width, 80);
        assert_int_equal(v[i].height, 60);
        near((double)v[i].fx, 80.0, 1e-4); /* the lens of a key half as wide is the same */
        near((double)v[i].cx, 40.0, 1e-4);
        ted4_view_centre(&v[i], centre);
        near(centre[0], 0.5 * i, i % 2 == 0 ? 1e-5 : 0.1);
        near(centre[1], 0.0, 1e-5);
        for (int k = 0; k < 9; k++)
            near((double)v[i].R[k], (double)want.view.R[k], 1e-5);
    }
    /* One picture, or one key: the first key. */
    ted4_path_between(&l, 1, v);
    near((double)v[0].R[0], 1.0, 1e-6);
    ted4_path_between(&(ted4_camera_list) { .camera = keys, .n = 1 }, 3, v);
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 9; k++)
            near((double)v[i].R[k], (double)keys[0].view.R[k], 1e-6);
}

/* A view's axes are right, down and forward; up is seen upwards, and the centre in the middle. */
static void check_orbit(const ted4_orbit *o, const ted4_view *v)
{
    double c[3], d[3], seen = 0.0, along = 0.0, square = 0.0, up = 0.0, across = 0.0;

    assert_true(ted4_is_rotation(v->R));
    ted4_view_centre(v, c);
    for (int k = 0; k < 3; k++) {
        d[k] = c[k] - o->centre[k];
        along += d[k] * o->up[k];
        square += d[k] * d[k];
        up += (double)v->R[3 + k] * o->up[k];
        across += (double)v->R[k] * o->up[k];
    }
    near(along, o->height, 1e-5);
    near(square, o->radius * o->radius + o->height * o->height, 1e-4);
    assert_true(up < 0.0);
    near(across, 0.0, 1e-6);
    for (int r = 0; r < 3; r++) {
        seen = (double)v->t[r];
        for (int k = 0; k < 3; k++)
            seen += (double)v->R[3 * r + k] * o->centre[k];
        near(seen, r < 2 ? 0.0 : sqrt(square), 1e-5);
    }
}

static void test_orbit(void **state)
{
    ted4_orbit o = { { 1, -2, 3 }, { 0, 0.6, 0.8 }, { 1, 0, 0 }, 0.0, 4.0, 1.5, { .width = 8 } };
    ted4_listed_camera list[12];
    const ted4_camera_list l = { .camera = list, .n = 12 };
    ted4_orbit found = { .up = { 0, 0.6, 0.8 } };
    ted4_view v[12];

    (void)state;
    ted4_orbit_around(&o, 12, v);
    for (int i = 0; i < 12; i++) {
        check_orbit(&o, &v[i]);
        list[i].view = v[i];
    }
    assert_int_equal(ted4_orbit_pivot(&l, found.centre), 0);
    ted4_orbit_of_cameras(&l, &found);
    for (int k = 0; k < 3; k++)
        near(found.centre[k], o.centre[k], 1e-4);
    near(found.radius, 4.0, 1e-4);
    near(found.height, 1.5, 1e-4);
    near(found.swing, 0.0, 0.0);
    /* Cameras on one side, and the swing that passes through all of them. */
    o.swing = 0.7;
    ted4_orbit_around(&o, 12, v);
    for (int i = 0; i < 12; i++) {
        check_orbit(&o, &v[i]);
        list[i].view = v[i];
    }
    ted4_orbit_of_cameras(&l, &found);
    near(found.swing, 0.7, 1e-4);
}

static void test_no_pivot(void **state)
{
    ted4_listed_camera keys[KEYS] = { key(0.0, 0.0, 80), key(0.0, 1.0, 80), key(0.0, 2.0, 80) };
    double centre[3];

    (void)state;
    assert_int_equal(ted4_orbit_pivot(&(ted4_camera_list) { .camera = keys, .n = KEYS }, centre),
                     -1);
    keys[0] = key(0.3, 0.0, 80); /* axes that meet behind the cameras */
    keys[2] = key(-0.3, 2.0, 80);
    const int one = ted4_orbit_pivot(&(ted4_camera_list) { .camera = keys, .n = KEYS }, centre);

    keys[0] = key(-0.3, 0.0, 80);
    keys[2] = key(0.3, 2.0, 80);
    const int other = ted4_orbit_pivot(&(ted4_camera_list) { .camera = keys, .n = KEYS }, centre);

    assert_int_equal(one + other, -1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_between),
        cmocka_unit_test(test_orbit),
        cmocka_unit_test(test_no_pivot),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
