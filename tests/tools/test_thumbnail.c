/* test_thumbnail.c - a thumbnail shows what the training picture shows, whose pixels are smaller
 * (annex I.4).
 * SPDX-License-Identifier: BSD-2-Clause */
#include <math.h>

#include "data/image_file.h"
#include "render/view.h"
#include "tool_files.h"
#include "tool/camera_view.h"
#include "tool/describe.h"

enum { LARGE = 2 * TED4_THUMBNAIL_MADE, SIDE = TED4_THUMBNAIL_MADE };

/* A camera before the scene. */
static ted4_camera large_camera(const ted4_info *info)
{
    ted4_camera c = { .width = LARGE,
                      .height = LARGE,
                      .fx = LARGE,
                      .fy = LARGE,
                      .cx = LARGE / 2,
                      .cy = LARGE / 2,
                      .R = { 1, 0, 0, 0, 1, 0, 0, 0, 1 } };

    for (int k = 0; k < 3; k++)
        c.t[k] = -(double)info->origin[k] + (k == 2 ? ldexp(2.5, info->exponent) : 0.0);
    return c;
}

/* What the camera sees in the middle of the scene's time: [LARGE][LARGE][3]. */
static uint8_t *large_picture(const ted4_camera *c)
{
    const ted4_info *const info = &file[1].info;
    const ted4_time t = ted4_time_of_frame(info->frames / 2, info->frames);
    uint8_t *const rgb = malloc((size_t)LARGE * LARGE * 3);
    ted4_viewer *const viewer = ted4_viewer_new();
    const ted4_view v = ted4_view_of_camera(c);

    assert_non_null(rgb);
    assert_non_null(viewer);
    assert_int_equal(ted4_render_query(viewer, file[1].recon, info, t.num, t.den, &v, NULL, rgb),
                     TED4_OK);
    ted4_viewer_free(viewer);
    return rgb;
}

static void test_thumbnail(void **state)
{
    enum { TIMES = LARGE / SIDE };
    const ted4_camera camera = large_camera(&file[1].info);
    ted4_picture picture = { .camera = camera };
    const ted4_dataset d = { .pictures = &picture, .n_pictures = 1, .n_frames = 1, .n_cameras = 1 };
    char why[256], path[PATH_SIZE];
    double error = 0.0, spread = 0.0;
    size_t size, png_size;
    ted4_message m;
    ted4_image small;

    (void)state;
    need_programs();
    uint8_t *const data = contents("v1.ted4", &size), *const large = large_picture(&camera);
    uint8_t *const png = ted4_describe_thumbnail(data, size, &d, NULL, &png_size, why, sizeof why);

    assert_non_null(png);
    write_contents("small.png", png, png_size);
    path_of(path, "small.png");
    assert_int_equal(ted4_image_read(path, &small, &m), 0);
    assert_int_equal(small.width, SIDE);
    assert_int_equal(small.height, SIDE);
    assert_int_equal(small.channels, 3);
    for (size_t i = 0; i < (size_t)SIDE * SIDE * 3; i++) {
        const size_t x = i / 3 % SIDE, y = i / 3 / SIDE;
        double mean = 0.0;

        for (size_t k = 0; k < TIMES * TIMES; k++)
            mean += large[((y * TIMES + k / TIMES) * LARGE + x * TIMES + k % TIMES) * 3 + i % 3];
        mean /= TIMES * TIMES;
        error += (small.bytes[i] - mean) * (small.bytes[i] - mean);
        spread += (mean - file[1].info.background[i % 3]) * (mean - file[1].info.background[i % 3]);
    }
    print_message("%.1f dB below what is to be seen\n", 10.0 * log10(spread / error));
    assert_true(spread > 10.0 * error);
    free(small.bytes);
    free(large);
    free(data);
    free(png);
}

int main(void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test(test_thumbnail) };

    return cmocka_run_group_tests(tests, setup, teardown);
}
