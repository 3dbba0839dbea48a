/* test_dataset_real.c - the real scenes below $TED4_DATA load as the expected datasets; skipped
 * where they are absent.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <math.h>

#include "test.h"
#include "data/data_util.h"
#include "data/point_cloud.h"
#include "data/raw_scene.h"
#include "tiny_scene.h"

/* Counts from the README beside the real scenes. The picture's name gives the frame, where names
 * are numbers from 0 or 1. */
static void test_real(void **state)
{
    (void)state;
    static const struct {
        const char *name;
        size_t train, test;
        uint32_t cameras, frames;
        int width, height;
        size_t points;
    } scenes[] = {
        { "dog", 107, 15, 1, 122, 640, 359, 23642 },
        { "chair", 100, 25, 125, 1, 400, 400, TED4_RANDOM_POINTS },
        { "kitchen", 520, 40, 14, 40, 480, 270, 15000 },
        { "kitchen_tint", 520, 40, 14, 40, 240, 135, 15000 },
        { "walk", 80, 80, 2, 80, 270, 480, 15000 },
        { "still", 104, 8, 14, 8, 480, 270, 15000 },
    };
    const char *base = getenv("TED4_DATA");

    for (size_t s = 0; s < sizeof scenes / sizeof scenes[0]; s++) {
        tiny_folder f;
        ted4_dataset d;
        snprintf(f.path, sizeof f.path, "%s/%s", base == NULL ? "" : base, scenes[s].name);
        if (base == NULL || !ted4_is_folder(f.path)) {
            print_message("skipped: no scene %s under TED4_DATA\n", scenes[s].name);
            skip();
        }
        assert_string_equal(tiny_load(&d, &f, &tiny_options), "");
        size_t n_test = 0;
        for (size_t i = 0; i < d.n_pictures; i++) {
            n_test += d.pictures[i].is_test;
            const int number = atoi(strrchr(d.pictures[i].path, '/') + 1) -
                               (strcmp(scenes[s].name, "dog") == 0);
            if (scenes[s].frames > 1)
                assert_int_equal(d.pictures[i].frame, number);
        }
        assert_int_equal(d.n_pictures - n_test, scenes[s].train);
        assert_int_equal(n_test, scenes[s].test);
        assert_int_equal(d.n_cameras, scenes[s].cameras);
        assert_int_equal(d.n_frames, scenes[s].frames);
        assert_int_equal(d.pictures[0].camera.width, scenes[s].width);
        assert_int_equal(d.pictures[0].camera.height, scenes[s].height);
        assert_int_equal(d.n_points, scenes[s].points);
        ted4_dataset_free(&d);
    }
}

/* Four fixed cameras, each with a video and a distorting lens: the first five frames, of which the
 * last is held out. */
static void test_real_videos(void **state)
{
    (void)state;
    const char *base = getenv("TED4_DATA");
    ted4_dataset_options o = tiny_options;
    ted4_message m;
    ted4_dataset d;
    tiny_folder f, cache;

    snprintf(f.path, sizeof f.path, "%s/treadmill", base == NULL ? "" : base);
    if (base == NULL || !ted4_is_folder(f.path) || system("ffmpeg -version >/dev/null 2>&1") != 0) {
        print_message("skipped: no scene treadmill under TED4_DATA, or no ffmpeg\n");
        skip();
    }
    cache = tiny_new();
    setenv("XDG_CACHE_HOME", cache.path, 1);
    o.max_frames = 5;
    assert_string_equal(tiny_load(&d, &f, &o), "");
    assert_string_equal(d.layout, "calibration");
    assert_int_equal(d.n_pictures, 20);
    assert_int_equal(d.n_cameras, 4);
    assert_int_equal(d.n_frames, 5);
    assert_true(d.rate == 60);
    for (size_t i = 0; i < d.n_pictures; i++) {
        const ted4_camera *c = &d.pictures[i].camera;
        assert_int_equal(d.pictures[i].is_test, d.pictures[i].frame == 4);
        assert_int_equal(c->width, 1088);
        assert_int_equal(c->height, 1920);
        assert_true(fabs(c->fx - 1677) < 6);
        assert_true(fabs(c->fy - 1677) < 6);
    }
    assert_true(fabs(d.pictures[0].camera.cx - (532.97369384375 + 0.5)) <= 1e-9);
    assert_non_null(ted4_dataset_pixels(&d, 0, &m));
    ted4_dataset_release(&d, 0);
    ted4_dataset_free(&d);
    unsetenv("XDG_CACHE_HOME");
    tiny_free(&cache);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_real),
        cmocka_unit_test(test_real_videos),
    };

    return cmocka_run_group_tests_name("dataset_real", tests, NULL, NULL);
}
