/* test_fit_colours.c - tool/fit_colours.h on a scene of three cameras: the map between what is
 * drawn and what a camera shows is found from its training pictures alone.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "test.h"
#include "tiny_scene.h"
#include "tool/fit_colours.h"

enum { PIXELS = TINY_W * TINY_H, CAMERAS = 3, TIMES = 40, BY_TEST_ONLY = 2, FLAT = 1 };

/* Camera 0: what it makes of colours. Camera 1 shows one grey only. Camera 2 has test pictures
 * only. */
static const ted4_colour_map truth_map = { -0.2f, 0.02f, 0,    0.01f, -0.1f, 0,
                                           0,     0.03f, 0.1f, 0.05f, 0,     -0.02f };

static tiny_folder folder;
static ted4_dataset data;
static size_t drawn[CAMERAS * TIMES], n_drawn;
static int fail_with;

/* Fills rgb with what the file shows at a time. */
static void show(uint32_t frame, uint8_t *rgb)
{
    for (int i = 0; i < PIXELS; i++) {
        rgb[3 * i] = (uint8_t)(30 + i % TINY_W * 12);
        rgb[3 * i + 1] = (uint8_t)(40 + i / TINY_W * 13);
        rgb[3 * i + 2] = (uint8_t)(50 + (i * 7 + (int)frame * 11) % 150);
    }
}

static int draw(void *user, size_t i, uint8_t *rgb)
{
    assert_ptr_equal(user, &data);
    drawn[n_drawn++] = i;
    show(data.pictures[i].frame, rgb);
    return fail_with;
}

static int is_test(int camera, int time)
{
    return camera == BY_TEST_ONLY || time % 8 == 4;
}

static void write_picture(int camera, int time, const char *name)
{
    uint8_t seen[3 * PIXELS], to[3 * PIXELS];

    show((uint32_t)time, seen);
    for (int i = 0; i < 3 * PIXELS; i++) {
        double x = seen[i] / 255.0 + (double)truth_map[9 + i % 3];

        for (int r = 0; r < 3; r++)
            x += seen[i - i % 3 + r] / 255.0 * (double)truth_map[3 * r + i % 3];
        to[i] = camera == FLAT ? 99 : (uint8_t)(255 * x + 0.5);
    }
    tiny_png(&folder, name, TINY_W, TINY_H, PNG_FORMAT_RGB, to);
}

static void write_split(int test, const char *name)
{
    static tiny_string s;
    int n = 0;

    s.n = 0;
    tiny_add(&s, "{\"camera_angle_x\": 1.5, \"frames\": [");
    for (int c = 0; c < CAMERAS; c++)
        for (int t = 0; t < TIMES; t++) {
            char picture[32];

            if (is_test(c, t) != test)
                continue;
            snprintf(picture, sizeof picture, "c%d_%02d", c, t);
            tiny_frame(&s, n++ == 0, picture, t / (TIMES - 1.0), c, 0);
            strcat(picture, ".png");
            write_picture(c, t, picture);
        }
    tiny_add(&s, "]}");
    tiny_text(&folder, name, s.text);
}

static int set_up(void **state)
{
    (void)state;
    folder = tiny_new();
    write_split(0, "transforms_train.json");
    write_split(1, "transforms_test.json");
    n_drawn = 0;
    fail_with = 0;
    return tiny_load(&data, &folder, &tiny_options)[0] != 0;
}

static int tear_down(void **state)
{
    (void)state;
    ted4_dataset_free(&data);
    tiny_free(&folder);
    return 0;
}

/* Returns the number of the camera of the scene. */
static uint32_t number_of(int camera)
{
    for (size_t i = 0; i < data.n_pictures; i++)
        if (data.pictures[i].camera.t[0] == -camera)
            return data.pictures[i].camera_id;
    fail();
    return 0;
}

static void fit(ted4_fitted_colours *of)
{
    ted4_message m;

    assert_int_equal(data.n_cameras, CAMERAS);
    assert_int_equal(ted4_fit_colours(&data, 1, draw, &data, of, &m), 0);
}

static void test_map_is_found(void **state)
{
    ted4_fitted_colours of[CAMERAS];
    const float *map;

    (void)state;
    fit(of);
    map = of[number_of(0)].map;
    for (int k = 0; k < TED4_COLOUR_VALUES; k++)
        if (!(fabsf(map[k] - truth_map[k]) < 0.005f))
            fail_msg("value %d: %g, not %g", k, (double)map[k], (double)truth_map[k]);
}

/* The 16 pictures lie evenly among the 35 training pictures, and no test picture is drawn. */
static void test_pictures_are_spread(void **state)
{
    ted4_fitted_colours of[CAMERAS];
    size_t last = 0, n = 0;

    (void)state;
    fit(of);
    assert_int_equal(of[number_of(0)].pictures, TED4_FIT_PICTURES);
    for (size_t i = 0; i < n_drawn; i++) {
        const ted4_picture *const p = &data.pictures[drawn[i]];

        assert_int_equal(p->is_test, 0);
        if (p->camera_id != number_of(0))
            continue;
        if (n++ > 0)
            assert_in_range(p->frame - data.pictures[last].frame, 2, 4);
        last = drawn[i];
    }
    assert_int_equal(n, TED4_FIT_PICTURES);
}

static void test_camera_without_training_pictures(void **state)
{
    ted4_fitted_colours of[CAMERAS];

    (void)state;
    fit(of);
    assert_int_equal(of[number_of(BY_TEST_ONLY)].pictures, 0);
}

/* Other test pictures leave every map as it is. */
static void test_held_out_pictures_do_not_count(void **state)
{
    ted4_fitted_colours of[CAMERAS], with[CAMERAS];
    uint8_t black[3 * PIXELS] = { 0 };

    (void)state;
    fit(of);
    for (int t = 0; t < TIMES; t++) {
        char name[32];

        snprintf(name, sizeof name, "c0_%02d.png", t);
        if (is_test(0, t))
            tiny_png(&folder, name, TINY_W, TINY_H, PNG_FORMAT_RGB, black);
    }
    fit(with);
    assert_memory_equal(of, with, sizeof of);
}

/* A camera that shows one colour has a map that makes this colour of any other. */
static void test_flat_pictures(void **state)
{
    ted4_fitted_colours of[CAMERAS];
    uint8_t seen[3 * PIXELS], grey[3 * PIXELS];

    (void)state;
    fit(of);
    show(0, seen);
    memset(grey, 99, sizeof grey);
    assert_true(ted4_fitted_psnr(of[number_of(FLAT)].map, grey, seen, PIXELS) > 50);
}

static void test_psnr(void **state)
{
    static const ted4_colour_map identity = { 0 }, brighter = { [9] = 1, 1, 1 },
                                 red = { [9] = 10 / 255.0f };
    uint8_t a[3 * PIXELS], b[3 * PIXELS];

    (void)state;
    memset(a, 100, sizeof a);
    memset(b, 100, sizeof b);
    assert_true(isinf(ted4_fitted_psnr(identity, a, b, PIXELS)));
    /* Values above 255 are 255. */
    memset(a, 255, sizeof a);
    assert_true(isinf(ted4_fitted_psnr(brighter, a, b, PIXELS)));
    memset(a, 100, sizeof a);
    assert_true(fabs(ted4_fitted_psnr(red, a, b, PIXELS) - 10 * log10(3 * 25.5 * 25.5)) < 1e-4);
}

static void test_failures(void **state)
{
    ted4_fitted_colours of[CAMERAS];
    ted4_message m;

    (void)state;
    fail_with = 3;
    assert_int_equal(ted4_fit_colours(&data, 1, draw, &data, of, &m), 3);
    assert_int_equal(n_drawn, 1);
    fail_with = 0;
    remove(tiny_path(&folder, "c0_00.png"));
    assert_int_equal(ted4_fit_colours(&data, 1, draw, &data, of, &m), -1);
    assert_non_null(strstr(m.text, "c0_00.png"));
}

#define CASE(f) cmocka_unit_test_setup_teardown(f, set_up, tear_down)

int main(void)
{
    const struct CMUnitTest tests[] = {
        CASE(test_map_is_found),
        CASE(test_pictures_are_spread),
        CASE(test_camera_without_training_pictures),
        CASE(test_held_out_pictures_do_not_count),
        CASE(test_flat_pictures),
        CASE(test_psnr),
        CASE(test_failures),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
