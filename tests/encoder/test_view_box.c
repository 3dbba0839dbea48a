/* test_view_box.c - data/source.h: the cube at which cameras look, where their axes meet, where
 * they do not, and where they meet at the cameras only.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <math.h>
#include <string.h>

#include "test.h"
#include "data/source.h"
#include "train/math/random.h"

#define PI 3.14159265358979323846

enum { MOST = 64 };

static ted4_picture pictures[MOST];

/* Puts camera i at a place, looking along a direction of any length; y is up in the picture's plane
 * unless the direction is y. */
static void put(size_t i, const double centre[3], const double direction[3])
{
    ted4_camera *k = &pictures[i].camera;
    const double *d = direction;
    const double length = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
    const double flat = sqrt(d[0] * d[0] + d[2] * d[2]);
    const double f[3] = { d[0] / length, d[1] / length, d[2] / length };
    const double right[3] = { d[2] / flat, 0, -d[0] / flat };
    const double down[3] = { f[1] * right[2], f[2] * right[0] - f[0] * right[2], -f[1] * right[0] };

    for (int j = 0; j < 3; j++) {
        k->R[j] = right[j];
        k->R[3 + j] = down[j];
        k->R[6 + j] = f[j];
    }
    for (int r = 0; r < 3; r++)
        k->t[r] =
            -(k->R[3 * r] * centre[0] + k->R[3 * r + 1] * centre[1] + k->R[3 * r + 2] * centre[2]);
}

/* Asserts the centre and half the side of n cameras' cube, within a distance. */
static void expect(size_t n, double x, double y, double z, double half, double within)
{
    const ted4_dataset d = { .pictures = pictures, .n_pictures = n };
    const double expected[4] = { x, y, z, half };
    double found[4];

    assert_int_equal(ted4_view_box(&d, found, &found[3]), 0);
    for (int j = 0; j < 4; j++)
        if (!(fabs(found[j] - expected[j]) <= within))
            fail_msg("centre %g %g %g, half %g; expected %g %g %g, %g", found[0], found[1],
                     found[2], found[3], x, y, z, half);
}

/* A value from -1 to 1. */
static double noise(size_t i)
{
    return 2 * (double)ted4_uniform(11, i) - 1;
}

/* Cameras at distance 5 around a point look at it; then they miss it by up to a fifth of that. */
static void test_around_a_point(void **state)
{
    (void)state;
    for (int missed = 0; missed < 2; missed++) {
        for (size_t i = 0; i < MOST; i++) {
            const double a = 2 * PI * (double)i / MOST;
            const double c[3] = { 1 + 4 * cos(a), 5, 3 + 4 * sin(a) };
            double to[3] = { 1 - c[0], 2 - c[1], 3 - c[2] };
            for (size_t j = 0; j < 3; j++)
                to[j] += missed * noise(3 * i + j);
            put(i, c, to);
        }
        expect(MOST, 1, 2, 3, 0.6 * 5, missed ? 0.4 : 1e-9);
    }
}

/* One camera that stands still, and a row of cameras with parallel axes. */
static void test_parallel(void **state)
{
    const double forward[3] = { 0, 0, 2 };

    (void)state;
    for (size_t i = 0; i < MOST; i++)
        put(i, (double[3]) { 1, 2, 3 }, forward);
    expect(MOST, 1, 2, 4, 0.6, 1e-9);
    for (size_t i = 0; i < 3; i++)
        put(i, (double[3]) { 30 * (double)i, 2, 3 }, forward);
    const double spread = sqrt(600);
    expect(3, 30, 2, 3 + spread, 0.6 * hypot(30, spread), 1e-9);
}

/* A camera that turns about itself by a sixth of a circle, on a tripod or in a hand that trembles:
 * its axes meet at the camera, which is not what it looks at. */
static void test_turns_about_itself(void **state)
{
    (void)state;
    for (int trembles = 0; trembles < 2; trembles++) {
        const double by = trembles ? 0.01 : 1e-12;
        for (size_t i = 0; i < MOST; i++) {
            const double a = PI / 3 * ((double)i / (MOST - 1) - 0.5);
            const double c[3] = { 7 + by * noise(3 * i), by * noise(3 * i + 1),
                                  by * noise(3 * i + 2) };
            put(i, c, (double[3]) { sin(a), 0.2 * noise(3 * i), cos(a) });
        }
        expect(MOST, 7, 0, 1, 0.6, 0.1);
    }
}

/* Cameras that look all around: from one place, and outwards from a circle of radius 5, where half
 * the places at a depth of 5 are 10 from the middle. */
static void test_all_around(void **state)
{
    (void)state;
    for (int apart = 0; apart < 2; apart++) {
        for (size_t i = 0; i < MOST; i++) {
            const double a = 2 * PI * (double)i / MOST;
            const double out[3] = { 5 * cos(a), 0, 5 * sin(a) };
            put(i, (double[3]) { apart * out[0], 1, apart * out[2] }, out);
        }
        expect(MOST, 0, 1, 0, apart ? 0.6 * 10 : 0.6, 1e-9);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_around_a_point),
        cmocka_unit_test(test_parallel),
        cmocka_unit_test(test_turns_about_itself),
        cmocka_unit_test(test_all_around),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
