/* test_scatter.c - data/shown.h, data/sweep.h and data/scatter.h: what counts as plain background;
 * which of many pictures are looked at; points are placed where pictures show something, at the
 * depth at which they agree; useful points stay.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "test.h"

#define BALL_FRAMES 3
#include "ball_group.h"
#include "data/scatter.h"
#include "data/shown.h"
#include "data/sweep.h"
#include "tool/threads.h"
#include "train/math/random.h"

static int set_up_still(void **state)
{
    ted4_message m;

    (void)state;
    ball_load(&folder, &balls, FRAMES, 0);
    assert_int_equal(ted4_dataset_verify(&balls, NULL, &m), 0);
    return 0;
}

/* Distance, in radii, from the surface of the nearest ball. */
static double beside(const float *p)
{
    double best = INFINITY;

    for (int k = 0; k < BALLS; k++) {
        const ball b = ball_at(k, 0);
        const double x = (double)p[0] - b.centre[0], y = (double)p[1] - b.centre[1],
                     z = (double)p[2] - b.centre[2];

        best = fmin(best, fabs(sqrt(x * x + y * y + z * z) / b.radius - 1));
    }
    return best;
}

static size_t count_near(const ted4_dataset *d, double most)
{
    size_t n = 0;

    for (size_t i = 0; i < d->n_points; i++)
        n += beside(d->points + 3 * i) < most;
    return n;
}

/* Loads a scene with wrong points: they are times as far from the middle as the balls. */
static void load(ted4_dataset *d, tiny_folder *f, double times)
{
    ted4_message m;

    ball_load(f, d, FRAMES, 0);
    for (size_t i = 0; times > 0 && i < 3 * d->n_points; i++)
        d->points[i] = (float)(times * (2 * (double)ted4_uniform(7, i) - 1));
    assert_int_equal(ted4_dataset_verify(d, NULL, &m), 0);
}

static void unload(ted4_dataset *d, tiny_folder *f)
{
    ted4_dataset_free(d);
    tiny_free(f);
}

static ted4_scattered scatter(ted4_dataset *d, const ted4_parallel *p)
{
    const ted4_scatter_options o = { .seed = 1 };
    ted4_scattered what;
    ted4_message m;

    if (ted4_dataset_scatter(d, &o, p, &what, &m) != 0)
        fail_msg("%s", m.text);
    return what;
}

static void test_shown(void **state)
{
    const ball b = ball_at(0, 0);
    const double nowhere[3] = { 0, 0, 1e6 };
    ted4_message m;
    ted4_shown s;
    int seen, shown;
    size_t n = 0;

    (void)state;
    for (size_t i = 0; i < balls.n_pictures; i++)
        n += !balls.pictures[i].is_test;
    assert_true(n < balls.n_pictures);
    assert_int_equal(ted4_shown_read(&s, &balls, &m), 0);
    assert_true(s.plain);
    assert_int_equal(s.n, n);
    assert_int_equal(s.background[0], 0);
    assert_int_equal(s.background[1], 0);
    assert_int_equal(s.background[2], 0);
    ted4_shown_count(&s, b.centre, &seen, &shown);
    assert_int_equal(seen, shown);
    assert_int_equal(seen, (int)s.n);
    ted4_shown_count(&s, nowhere, &seen, &shown);
    assert_int_equal(shown, 0);
    ted4_shown_free(&s);
}

/* Loads a scene of n training pictures from places along a line, picture i of the time
 * step i + 1, and two held-out ones of the times 0 and step n. */
static void load_row(ted4_dataset *d, tiny_folder *f, int n, int step)
{
    const ted4_dataset_options o = tiny_options;
    tiny_string train = { "", 0 }, test = { "", 0 };
    char name[32];
    ted4_message m;

    *f = tiny_new();
    tiny_add(&train, "{\"camera_angle_x\": 0.9, \"frames\": [");
    tiny_add(&test, "{\"camera_angle_x\": 0.9, \"frames\": [");
    for (int i = 0; i < n + 2; i++) {
        const double time = i < n ? step > 0 ? step * i + 1 : 0 : (i - n) * step * n;

        snprintf(name, sizeof name, "%d.png", i);
        tiny_picture(f, name, 8, 6, i);
        snprintf(name, sizeof name, "%d", i);
        tiny_frame(i < n ? &train : &test, i == 0 || i == n, name, time / 1000, i, 5);
    }
    tiny_add(&train, "]}");
    tiny_add(&test, "]}");
    tiny_text(f, "transforms_train.json", train.text);
    tiny_text(f, "transforms_test.json", test.text);
    assert_string_equal(tiny_load(d, f, &o), "");
    assert_int_equal(ted4_dataset_verify(d, NULL, &m), 0);
}

/* Of many pictures, those of evenly spaced frames are looked at, among the frames that have
 * training pictures; of many pictures of one frame, evenly spaced ones. */
static void test_many_pictures(void **state)
{
    enum { PICTURES = 140 };
    static const int step[] = { 2, 0 };
    static const size_t want[] = { PICTURES / 2, TED4_SHOWN_MOST };
    tiny_folder f;
    ted4_dataset d;
    ted4_message m;
    ted4_shown s;

    (void)state;
    for (int i = 0; i < 2; i++) {
        load_row(&d, &f, PICTURES, step[i]);
        assert_int_equal(ted4_shown_read(&s, &d, &m), 0);
        assert_int_equal(s.n, want[i]);
        assert_int_equal(s.picture[0], 0);
        assert_true(s.picture[s.n - 1] >= PICTURES - 2);
        for (size_t k = 1; k < s.n; k++) {
            assert_true(s.picture[k] > s.picture[k - 1]);
            assert_true(s.picture[k] <= s.picture[k - 1] + 2);
        }
        ted4_shown_free(&s);
        unload(&d, &f);
    }
}

/* Pictures with transparency lie on white; the colour of their opaque borders is no background. */
static void test_transparent(void **state)
{
    enum { W = 24, H = 18 };
    uint8_t px[H][W][4];
    tiny_folder f;
    ted4_dataset d;
    ted4_message m;

    (void)state;
    load_row(&d, &f, 4, 2);
    ted4_dataset_free(&d);
    for (int y = 0; y < H; y++)
        for (int x = 0; x < W; x++) {
            const int inside = x > 5 && x < 18 && y > 4 && y < 13;
            const uint8_t pixel[4] = { inside ? 200 : 20, 20, 20, inside ? 120 : 255 };

            memcpy(px[y][x], pixel, sizeof pixel);
        }
    for (int i = 0; i < 6; i++) {
        char name[32];

        snprintf(name, sizeof name, "%d.png", i);
        tiny_png(&f, name, W, H, PNG_FORMAT_RGBA, px[0][0]);
    }
    assert_string_equal(tiny_load(&d, &f, &tiny_options), "");
    assert_int_equal(ted4_dataset_verify(&d, NULL, &m), 0);
    scatter(&d, NULL);
    for (int k = 0; k < 3; k++)
        assert_int_equal(d.background[k], 255);
    unload(&d, &f);
}

/* The depth of a pixel that shows a ball is that of the ball's front side. */
static void test_sweep(void **state)
{
    ted4_message m;
    ted4_shown s;
    ted4_sweep w;
    size_t found = 0, near = 0;

    (void)state;
    assert_int_equal(ted4_shown_read(&s, &balls, &m), 0);
    ted4_sweep_begin(&w, &s, 4, 1, 12);
    w.agreed = 4;
    for (size_t i = 0; i < s.n; i++) {
        assert_in_range(w.n_helpers[i], 2, BALL_CAMERAS - 1);
        for (int h = 0; h < w.n_helpers[i]; h++)
            assert_int_equal(balls.pictures[s.picture[w.helper[i][h]]].frame,
                             balls.pictures[s.picture[i]].frame);
        for (size_t pixel = 0; pixel < BALL_W * BALL_H; pixel++) {
            double world[3];

            if (!ted4_shown_at(&s, i, pixel) || !ted4_sweep_pixel(&w, i, pixel, 0.5, world))
                continue;
            const float p[3] = { (float)world[0], (float)world[1], (float)world[2] };

            found++;
            near += beside(p) < 0.5;
        }
    }
    print_message("%zu pixels have a depth, %zu near a surface\n", found, near);
    assert_true(found >= 100);
    assert_true(4 * near >= 3 * found);
    ted4_shown_free(&s);
}

/* If the points fill a space ten times as wide as the objects, other points replace them, the same
 * for any number of threads. */
static void test_useless(void **state)
{
    ted4_dataset one, two;
    tiny_folder f[2];
    ted4_parallel p;

    (void)state;
    load(&one, &f[0], 10);
    load(&two, &f[1], 30);
    ted4_threads_init(&p, 3);

    const ted4_scattered a = scatter(&one, NULL), b = scatter(&two, &p);

    assert_int_equal(a.given, BALLS * BALL_POINTS);
    assert_true(a.scattered > 1000);
    assert_int_equal(a.scattered, one.n_points);
    assert_false(one.random_points);
    assert_int_equal(b.scattered, a.scattered);
    assert_memory_equal(one.points, two.points, 3 * one.n_points * sizeof *one.points);
    print_message("%zu points, %zu near a surface\n", one.n_points, count_near(&one, 1.0));
    assert_true(2 * count_near(&one, 1.0) > one.n_points);
    ted4_threads_finish(&p);
    unload(&one, &f[0]);
    unload(&two, &f[1]);
}

/* Points on objects are kept. */
static void test_useful(void **state)
{
    ted4_dataset d;
    tiny_folder f;

    (void)state;
    load(&d, &f, 0);

    const uint64_t before = ted4_dataset_digest(&d);
    const ted4_scattered what = scatter(&d, NULL);

    assert_int_equal(what.given, 0);
    assert_int_equal(what.scattered, 0);
    assert_true(!d.random_points);
    assert_int_equal(ted4_dataset_digest(&d), before);
    unload(&d, &f);
}

/* One picture does not determine depths: a few points are placed at random depths on the rays of
 * pixels that show something. */
static void test_one_picture(void **state)
{
    ted4_dataset d;
    tiny_folder f;
    ted4_message m;
    ted4_shown s;

    (void)state;
    load(&d, &f, 10);
    for (size_t i = 1; i < d.n_pictures; i++)
        d.pictures[i].is_test = 1;
    assert_int_equal(scatter(&d, NULL).scattered, 2048);
    assert_int_equal(d.n_points, 2048);
    assert_int_equal(ted4_shown_read(&s, &d, &m), 0);
    for (size_t i = 0; i < d.n_points; i++) {
        const float *p = d.points + 3 * i;
        int seen, shown;

        ted4_shown_count(&s, (double[3]) { (double)p[0], (double)p[1], (double)p[2] }, &seen,
                         &shown);
        assert_int_equal(seen, 1);
        assert_int_equal(shown, 1);
    }
    ted4_shown_free(&s);
    unload(&d, &f);
}

/* Held-out pictures are not read: without their files the result is the same. */
static void test_held_out(void **state)
{
    ted4_dataset d, same;
    tiny_folder f, g;

    (void)state;
    load(&d, &f, 10);
    load(&same, &g, 10);
    for (size_t i = d.n_pictures - BALL_CAMERAS; i < d.n_pictures; i++) {
        d.pictures[i].is_test = same.pictures[i].is_test = 1;
        for (int k = 0; k < 3; k++)
            d.pictures[i].camera.t[k] += 5;
    }
    assert_int_equal(scatter(&d, NULL).scattered, scatter(&same, NULL).scattered);
    assert_memory_equal(d.points, same.points, 3 * d.n_points * sizeof *d.points);
    unload(&d, &f);
    unload(&same, &g);
}

/* All points lie inside the bounds, those of the scene and those that replace them; if no point can
 * lie there, a message says so. */
static void test_bounds(void **state)
{
    const ball b = ball_at(0, 0);
    ted4_scatter_options o = { .seed = 1, .bounded = 1 };

    (void)state;
    for (int k = 0; k < 3; k++) {
        o.low[k] = (float)(b.centre[k] - 1.1 * b.radius);
        o.high[k] = (float)(b.centre[k] + 1.1 * b.radius);
    }
    for (int useful = 0; useful < 3; useful++) {
        ted4_dataset d;
        tiny_folder f;
        ted4_scattered what;
        ted4_message m;

        load(&d, &f, useful == 1 ? 0 : 10);
        if (useful == 2)
            o.low[0] = o.high[0] = 1e5f;
        assert_int_equal(ted4_dataset_scatter(&d, &o, NULL, &what, &m), useful == 2 ? -1 : 0);
        if (useful == 1) {
            assert_int_equal(what.scattered, 0);
            assert_true(d.n_points >= BALL_POINTS);
            assert_int_equal(d.n_points + what.outside, BALLS * BALL_POINTS);
        } else
            assert_int_equal((what.scattered > 0), (useful == 0));
        for (size_t i = 0; useful < 2 && i < 3 * d.n_points; i++) {
            assert_true(d.points[i] >= o.low[i % 3]);
            assert_true(d.points[i] <= o.high[i % 3]);
        }
        if (useful == 2)
            assert_non_null(strstr(m.text, "no initial point lies inside the bounds"));
        unload(&d, &f);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_shown),       cmocka_unit_test(test_sweep),
        cmocka_unit_test(test_useless),     cmocka_unit_test(test_useful),
        cmocka_unit_test(test_held_out),    cmocka_unit_test(test_bounds),
        cmocka_unit_test(test_one_picture), cmocka_unit_test(test_many_pictures),
        cmocka_unit_test(test_transparent),
    };

    return cmocka_run_group_tests_name("scatter", tests, set_up_still, tear_down);
}
