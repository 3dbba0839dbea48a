/* test_moving_pixels.c - tool/moving_pixels.h on a scene of three cameras: one that stands still,
 * one that moves, and one with too few pictures. A square of three pixels walks before a plain
 * wall, and is elsewhere in each picture. A lamp in a corner is on in the first of them, but in
 * fewer than half.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "test.h"
#include "tiny_scene.h"
#include "tool/moving_pixels.h"

enum { PIXELS = TINY_W * TINY_H, CAMERAS = 3, SIDE = 3, WALL = 80 };
enum { STILL, MOVES, FEW };

/* Pictures of each camera. */
static const int times[CAMERAS] = { 32, 8, TED4_MOVING_FEWEST - 1 };
enum { LAMP_ON = 13 };

static tiny_folder folder;
static ted4_dataset data;

/* The wall has another colour in each channel. The square differs from it in one of them: it is
 * brighter and darker in turns. */
static void show(int time, uint8_t rgb[3 * PIXELS])
{
    for (int i = 0; i < 3 * PIXELS; i++)
        rgb[i] = (uint8_t)(WALL + 10 * (i % 3));
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++)
            rgb[3 * ((y + time / 4 % 4 * SIDE) * TINY_W + x + time % 4 * SIDE) + 1] =
                time % 2 == 0 ? 200 : 5;
    if (time < LAMP_ON)
        rgb[3 * PIXELS - 1] = 255;
}

static void write_split(int test, const char *name)
{
    static tiny_string s;
    int n = 0;

    s.n = 0;
    tiny_add(&s, "{\"camera_angle_x\": 1.5, \"frames\": [");
    for (int c = 0; c < CAMERAS; c++)
        for (int t = 0; t < times[c]; t++) {
            uint8_t rgb[3 * PIXELS];
            char picture[32];

            if ((t % 4 == 2) != test)
                continue;
            snprintf(picture, sizeof picture, "c%d_%02d", c, t);
            tiny_frame(&s, n++ == 0, picture, t / 31.0, c, c == MOVES ? t : 0);
            strcat(picture, ".png");
            show(t, rgb);
            tiny_png(&folder, picture, TINY_W, TINY_H, PNG_FORMAT_RGB, rgb);
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
    return tiny_load(&data, &folder, &tiny_options)[0] != 0;
}

static int tear_down(void **state)
{
    (void)state;
    ted4_dataset_free(&data);
    tiny_free(&folder);
    return 0;
}

/* Returns a picture of the scene's camera c. */
static size_t picture_of(int c)
{
    for (size_t i = 0; i < data.n_pictures; i++)
        if (data.pictures[i].camera.t[0] == -c)
            return i;
    fail();
    return 0;
}

/* The median shows the wall alone, exactly, and no other camera has one. */
static void test_median(void **state)
{
    uint8_t **median;
    ted4_message m;
    const uint8_t *still;

    (void)state;
    for (int is_test = 0; is_test < 2; is_test++) {
        assert_int_equal(ted4_moving_medians(&data, is_test, &median, &m), 0);
        still = median[data.pictures[picture_of(STILL)].camera_id];
        assert_non_null(still);
        for (int i = 0; i < 3 * PIXELS; i++)
            assert_int_equal(still[i], WALL + 10 * (i % 3));
        for (uint32_t k = 0; k < data.n_cameras; k++)
            assert_true(median[k] == still || median[k] == NULL);
        ted4_moving_free(median, data.n_cameras);
    }
}

/* Pictures of one camera that differ in pose or lens, by whatever number, have no median. */
static void test_camera_that_changes(void **state)
{
    const size_t i = picture_of(STILL);
    ted4_camera *const c = &data.pictures[i].camera;
    const ted4_camera given = *c;
    double *const of[] = { &c->fx, &c->fy, &c->cx, &c->cy, &c->R[8], &c->t[2] };
    uint8_t **median;
    ted4_message m;

    (void)state;
    for (size_t k = 0; k < sizeof of / sizeof *of; k++) {
        *of[k] += 1e-3;
        assert_int_equal(ted4_moving_medians(&data, 0, &median, &m), 0);
        assert_null(median[data.pictures[i].camera_id]);
        ted4_moving_free(median, data.n_cameras);
        *c = given;
    }
}

/* One pixel differs from the median by the threshold, one by a level more in the last channel, one
 * is darker by as much: two show what moves, and no error elsewhere counts. */
static void test_sums(void **state)
{
    uint8_t median[12], truth[12], ours[12], mask[12];
    static const uint8_t want[12] = { 0, 0, 0, 255, 255, 255, 255, 255, 255 };
    ted4_moving_sum s = { 0 };

    (void)state;
    memset(median, 100, sizeof median);
    memcpy(truth, median, sizeof truth);
    truth[0] = 100 + TED4_MOVING_LEVELS;
    truth[5] = 101 + TED4_MOVING_LEVELS;
    truth[6] = 99 - TED4_MOVING_LEVELS;
    memcpy(ours, truth, sizeof ours);
    ours[1] = 0;
    ours[9] = 255;
    ted4_moving_add(&s, median, truth, ours, 4, mask);
    assert_memory_equal(mask, want, sizeof want);
    assert_int_equal(s.pixels, 2);
    assert_int_equal(s.views, 1);
    assert_true(isinf(ted4_moving_psnr(&s)));
    ours[3] -= 51;
    ted4_moving_add(&s, median, truth, ours, 4, NULL);
    assert_int_equal(s.pixels, 4);
    assert_int_equal(s.views, 2);
    /* One channel in twelve is wrong by a fifth. */
    assert_true(fabs(ted4_moving_psnr(&s) - 10 * log10(12 * 25.0)) < 1e-9);
}

static void test_nothing_moves(void **state)
{
    const uint8_t grey[3] = { 9, 9, 9 }, black[3] = { 0 };
    ted4_moving_sum s = { 0 };

    (void)state;
    ted4_moving_add(&s, grey, grey, black, 1, NULL);
    assert_int_equal(s.views, 1);
    assert_true(isnan(ted4_moving_psnr(&s)));
}

static void test_failures(void **state)
{
    uint8_t **median;
    ted4_message m;

    (void)state;
    remove(tiny_path(&folder, "c0_00.png"));
    assert_int_equal(ted4_moving_medians(&data, 0, &median, &m), -1);
    assert_non_null(strstr(m.text, "c0_00.png"));
    ted4_moving_free(median, data.n_cameras);
    ted4_moving_free(NULL, data.n_cameras);
}

#define CASE(f) cmocka_unit_test_setup_teardown(f, set_up, tear_down)

int main(void)
{
    const struct CMUnitTest tests[] = {
        CASE(test_median),   CASE(test_camera_that_changes),
        CASE(test_sums),     CASE(test_nothing_moves),
        CASE(test_failures),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
