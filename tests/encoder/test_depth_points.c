/* test_depth_points.c - data/depth_map.h and data/depth_points.h: depth maps of a room have its
 * true depths, also where it is plain; points lie on its surfaces; pictures that have nothing in
 * common give none.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "test.h"

#include "data/depth_points.h"
#include "depth_room.h"
#include "math/compare.h"
#include "tool/threads.h"

static room r;

static int set_up_room(void **state)
{
    (void)state;
    room_make(&r);
    return 0;
}

static int tear_down_room(void **state)
{
    (void)state;
    room_free(&r);
    return 0;
}

static ted4_sweep begin(const room *x)
{
    ted4_sweep w;

    ted4_sweep_begin(&w, &x->shown, 4, 1, 16);
    return w;
}

/* True inverse depth of the middle of a pixel; *plain: whether the wall is plain there. */
static double truth(int picture, int pixel, int *plain)
{
    double c[3], d[3], rgb[3];

    room_ray(&r, picture, pixel % ROOM_W + 0.5, pixel / ROOM_W + 0.5, c, d);

    const double z = room_trace(c, d, (int)r.picture[picture].frame, rgb);
    const double x = c[0] + z * d[0];

    *plain = fabs(c[2] + z * d[2] - ROOM_WALL) < 1e-9 && x > ROOM_PLAIN_FROM + 0.1 &&
             x < ROOM_PLAIN_TO - 0.1;
    return 1 / z;
}

/* Errors in planes: small nearly everywhere. In the plain part depths come from its border. */
static void test_depths(void **state)
{
    const ted4_sweep w = begin(&r);
    ted4_reduced all[ROOM_PICTURES];
    const ted4_reduced *helper[TED4_SWEEP_HELPERS];
    float *inverse = malloc(ROOM_W * ROOM_H * sizeof *inverse);
    double *off = malloc(ROOM_W * ROOM_H * sizeof *off);
    int plain = 0, right = 0, n = 0;

    (void)state;
    for (size_t i = 0; i < ROOM_PICTURES; i++)
        assert_int_equal(ted4_reduce(&all[i], &r.shown, i), 0);
    assert_int_equal(w.n_helpers[2], ROOM_CAMERAS - 1);
    for (int h = 0; h < w.n_helpers[2]; h++)
        helper[h] = &all[w.helper[2][h]];
    assert_int_equal(ted4_depth_map(&w, &all[2], helper, w.n_helpers[2], inverse), 0);
    for (int i = 0; i < ROOM_W * ROOM_H; i++) {
        int is_plain;
        const double e = fabs((double)inverse[i] - truth(2, i, &is_plain)) / ted4_depth_step(&w);

        if (is_plain) {
            plain++;
            right += e < 1.5;
        } else
            off[n++] = e;
    }
    qsort(off, (size_t)n, sizeof *off, ted4_compare_doubles);
    print_message("error in planes: half below %.2f, 90 %% below %.2f; plain: %d of %d right\n",
                  off[n / 2], off[9 * n / 10], right, plain);
    assert_true(off[n / 2] < 0.25);
    assert_true(off[9 * n / 10] < 1.5);
    assert_true(plain > 100 && 10 * right > 9 * plain);
    for (size_t i = 0; i < ROOM_PICTURES; i++)
        ted4_reduced_free(&all[i]);
    free(inverse);
    free(off);
}

static int keep_all(const void *user, const float xyz[3])
{
    (void)user;
    (void)xyz;
    return 1;
}

static int keep_left(const void *user, const float xyz[3])
{
    (void)user;
    return xyz[0] < 0;
}

static ted4_point_cloud find(const room *x, size_t most, int (*keep)(const void *, const float *),
                             const ted4_parallel *p)
{
    const ted4_sweep w = begin(x);
    const ted4_depth_wanted wanted = { most, 1, keep, NULL };
    ted4_point_cloud c;

    assert_int_equal(ted4_depth_points(&c, &w, &wanted, p), 0);
    return c;
}

/* Points lie on surfaces, on all of them, and have their colours. */
static void test_points(void **state)
{
    ted4_point_cloud c = find(&r, 100000, keep_all, NULL);
    size_t near = 0, part[4] = { 0 };

    (void)state;
    for (size_t i = 0; i < c.n; i++) {
        const float *p = c.xyz + 3 * i;

        near += room_beside(p) < 0.1;
        for (int f = 0; f < ROOM_FRAMES; f++) {
            double square = 0;

            for (int k = 0; k < 3; k++)
                square += pow((double)p[k] - room_ball[f][k], 2);
            part[f] += sqrt(square) < 1.05 * ROOM_RADIUS;
        }
        part[2] += (double)p[2] > ROOM_WALL - 0.05;
        part[3] += (double)p[1] > ROOM_FLOOR - 0.05;
    }
    print_message("%zu points, %zu near a surface; balls %zu and %zu, wall %zu, floor %zu\n", c.n,
                  near, part[0], part[1], part[2], part[3]);
    assert_true(2 * c.n > (size_t)ROOM_PICTURES * ROOM_W * ROOM_H);
    assert_true(100 * near > 97 * c.n);
    for (int k = 0; k < 4; k++)
        assert_true(part[k] > 1000);
    ted4_point_cloud_free(&c);
}

/* Fewer points are a part of all, the same for any number of threads; only wanted ones are
 * given. */
static void test_wanted(void **state)
{
    ted4_parallel p;

    (void)state;
    ted4_threads_init(&p, 3);

    ted4_point_cloud all = find(&r, 2000, keep_all, NULL), few = find(&r, 500, keep_all, &p),
                     left = find(&r, 500, keep_left, &p);

    assert_int_equal(all.n, 2000);
    assert_int_equal(few.n, 500);
    assert_memory_equal(all.xyz, few.xyz, 3 * few.n * sizeof *few.xyz);
    assert_memory_equal(all.rgb, few.rgb, 3 * few.n);
    for (size_t i = 0; i < left.n; i++)
        assert_true(left.xyz[3 * i] < 0);
    ted4_threads_finish(&p);
    ted4_point_cloud_free(&all);
    ted4_point_cloud_free(&few);
    ted4_point_cloud_free(&left);
}

/* Pictures that do not show the same thing, or one picture alone, give next to no points. */
static void test_nothing(void **state)
{
    room other;

    (void)state;
    room_make(&other);
    for (int i = 0; i < ROOM_PICTURES; i++)
        for (int k = 0; k < ROOM_W * ROOM_H * 3; k++)
            other.rgb[i][k] = (uint8_t)(ted4_mix((uint64_t)(i * ROOM_W * ROOM_H * 3 + k)) & 255);

    ted4_point_cloud c = find(&other, 100000, keep_all, NULL);

    print_message("%zu points of noise\n", c.n);
    assert_true(20 * c.n < (size_t)ROOM_PICTURES * ROOM_W * ROOM_H);
    ted4_point_cloud_free(&c);
    other.shown.n = 1;
    c = find(&other, 100000, keep_all, NULL);
    assert_int_equal(c.n, 0);
    ted4_point_cloud_free(&c);
    room_free(&other);
}

/* A reduced picture has at most TED4_DEPTH_CELLS cells, each the mean of its pixels, also if the
 * picture is narrower than a cell would be. */
static void test_reduce(void **state)
{
    static const int size[][2] = { { 400, 300 }, { 1, 30000 }, { 30000, 2 }, { 7, 5 } };

    (void)state;
    for (size_t k = 0; k < sizeof size / sizeof *size; k++) {
        const int width = size[k][0], height = size[k][1];
        ted4_picture picture = { .camera = { .width = width,
                                             .height = height,
                                             .fx = 300,
                                             .fy = 200,
                                             .cx = 0.5 * width,
                                             .cy = 0.5 * height } };
        ted4_dataset d = { .pictures = &picture, .n_pictures = 1 };
        ted4_shown s = { .data = &d, .n = 1 };
        uint8_t *rgb = malloc((size_t)width * (size_t)height * 3);
        ted4_reduced x;

        for (size_t i = 0; i < (size_t)width * (size_t)height; i++)
            for (size_t c = 0; c < 3; c++)
                rgb[3 * i + c] = (uint8_t)(i % 2 ? 100 : 50 * c);
        s.rgb[0] = rgb;
        assert_int_equal(ted4_reduce(&x, &s, 0), 0);

        const int n = (int)lrint(300 / x.camera.fx);

        assert_true(x.camera.width * x.camera.height <= TED4_DEPTH_CELLS);
        assert_int_equal(x.camera.width, width / n > 0 ? width / n : 1);
        assert_int_equal(x.camera.height, height / n > 0 ? height / n : 1);
        if (n % 2 == 0)
            assert_int_equal(x.cell[1], 75);
        ted4_reduced_free(&x);
        free(rgb);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_reduce),  cmocka_unit_test(test_depths),
        cmocka_unit_test(test_points),  cmocka_unit_test(test_wanted),
        cmocka_unit_test(test_nothing),
    };

    return cmocka_run_group_tests_name("depth points", tests, set_up_room, tear_down_room);
}
