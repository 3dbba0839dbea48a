/* test_useful.c - data/useful.h without a plain background: points on a textured wall are useful,
 * also if it faces the cameras; random points are not; if pictures agree everywhere, or nowhere,
 * they give no information, and points count as useful.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "test.h"
#include "data/useful.h"
#include "train/math/random.h"

/* Cameras side by side in front of a slanted wall, z = WALL + slant x, with a wave pattern in its
 * colour. */
enum { CAMERAS = 7, WIDTH = 128, HEIGHT = 96, POINTS = 3000 };
#define APART 0.3
#define WALL  4.0
#define SLANT 1.2
#define FOCAL 120.0

/* TINTED: the colours of the cameras differ by more than the texture does. */
typedef enum { TEXTURE, PLAIN, TINTED } look;

static const double height[] = { 20, 0, 8 };

typedef struct {
    ted4_dataset data;
    ted4_shown shown;
    ted4_picture pictures[CAMERAS];
    uint8_t rgb[CAMERAS][3 * WIDTH * HEIGHT];
    float points[3 * POINTS];
} wall;

static uint8_t wave(double x, double y, int channel, double high)
{
    const double s = sin((10 + channel) * x + 6 * y) + sin(5 * x - (12 - channel) * y);

    return (uint8_t)lround(80 + high * s);
}

static void draw(wall *w, int camera, look how, double slant)
{
    const double at = w->pictures[camera].camera.t[0];

    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        const double u = (i % WIDTH + 0.5 - WIDTH / 2) / FOCAL;
        const double v = (i / WIDTH + 0.5 - HEIGHT / 2) / FOCAL;
        const double z = (WALL - slant * at) / (1 - slant * u);

        for (int k = 0; k < 3; k++)
            w->rgb[camera][3 * i + k] = (uint8_t)(wave(u * z - at, v * z, k, height[how]) +
                                                  (how == TINTED ? 20 * camera : 0));
    }
}

/* Puts points on the wall, except for random_of_ten in ten, which lie in front of or behind it. */
static void put_points(wall *w, uint32_t random_of_ten, double slant)
{
    for (uint64_t i = 0; i < POINTS; i++) {
        const double x = 3 * (double)ted4_uniform(1, i) - 1.5;
        const double z = i % 10 < random_of_ten ? 2 + 6 * (double)ted4_uniform(2, i)
                                                : WALL + slant * x;

        w->points[3 * i] = (float)x;
        w->points[3 * i + 1] = 2 * ted4_uniform(3, i) - 1;
        w->points[3 * i + 2] = (float)z;
    }
}

static wall *build(look how, uint32_t random_of_ten, double slant)
{
    wall *w = calloc(1, sizeof *w);

    assert_non_null(w);
    w->data.pictures = w->pictures;
    w->data.n_pictures = w->shown.n = CAMERAS;
    w->data.points = w->points;
    w->data.n_points = POINTS;
    w->shown.data = &w->data;
    for (int i = 0; i < CAMERAS; i++) {
        w->pictures[i].camera = (ted4_camera) { WIDTH,
                                                HEIGHT,
                                                FOCAL,
                                                FOCAL,
                                                WIDTH / 2,
                                                HEIGHT / 2,
                                                { 1, 0, 0, 0, 1, 0, 0, 0, 1 },
                                                { APART * (CAMERAS / 2 - i), 0, 0 } };
        w->shown.picture[i] = (size_t)i;
        w->shown.rgb[i] = w->rgb[i];
        draw(w, i, how, slant);
    }
    put_points(w, random_of_ten, slant);
    return w;
}

static int are_useful(look how, uint32_t random_of_ten, double slant)
{
    wall *w = build(how, random_of_ten, slant);
    ted4_sweep sweep;

    ted4_sweep_begin(&sweep, &w->shown, WALL, 1, 16);
    sweep.agreed = 10;

    const int useful = ted4_points_are_useful(&sweep, 1);

    free(w);
    return useful;
}

static void test_surface(void **state)
{
    (void)state;
    assert_true(are_useful(TEXTURE, 0, SLANT));
    assert_true(are_useful(TEXTURE, 5, SLANT));
    assert_true(are_useful(TEXTURE, 0, 0));
}

static void test_random(void **state)
{
    (void)state;
    assert_false(are_useful(TEXTURE, 10, SLANT));
    assert_false(are_useful(TEXTURE, 10, 0));
}

/* If pictures give no information, any points count as useful. */
static void test_no_meta_lines(void **state)
{
    (void)state;
    for (uint32_t random = 0; random <= 10; random += 10) {
        assert_true(are_useful(PLAIN, random, SLANT));
        assert_true(are_useful(TINTED, random, SLANT));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_surface),
        cmocka_unit_test(test_random),
        cmocka_unit_test(test_no_meta_lines),
    };

    return cmocka_run_group_tests_name("useful", tests, NULL, NULL);
}
