/* test_widen.c - Gaussians widened for larger pictures than those of training: the width of a
 * camera's pixel, which camera counts, and pictures against those of annex I.4.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <math.h>

#include "render/view.h"
#include "tool_files.h"
#include "tool/widen.h"

enum { SIDE = 64, TIMES = 4, LARGE = TIMES * SIDE };

/* A camera at the origin that looks along z, with a field of view of 90 degrees. */
static ted4_listed_camera ahead(float fx)
{
    return (ted4_listed_camera) { .view = { .width = (int)(2.0f * fx),
                                            .height = (int)(2.0f * fx),
                                            .fx = fx,
                                            .fy = fx,
                                            .cx = fx,
                                            .cy = fx,
                                            .R = { 1, 0, 0, 0, 1, 0, 0, 0, 1 } } };
}

/* The variance, in units of 0.3 pixels of fx 100 at distance 1, that a Gaussian at x, y, z gains.
 */
static double gained(ted4_listed_camera *camera, size_t n, float x, float y, float z)
{
    const ted4_camera_list taken = { .camera = camera, .n = n };
    const float *const mean[3] = { &x, &y, &z };
    float s[3] = { 0.5f, 0.001f, 0.0f };
    double added[3];

    assert_int_equal(ted4_widen(&taken, 0.02f, 1, mean, (float *const[3]) { &s[0], &s[1], &s[2] }),
                     0);
    added[0] = (double)s[0] * (double)s[0] - 0.25;
    added[1] = (double)s[1] * (double)s[1] - 1e-6;
    added[2] = (double)s[2] * (double)s[2];
    assert_true(fabs(added[0] - added[2]) < 1e-6);
    assert_true(fabs(added[1] - added[2]) < 1e-6 * added[2]);
    return added[2] / (0.3 * 1e-4);
}

static void near(double got, double want)
{
    if (!(fabs(got - want) < 1e-5 * want))
        fail_msg("%.9g instead of %.9g", got, want);
}

static void test_width(void **state)
{
    ted4_listed_camera two[2] = { ahead(100), ahead(200) };

    (void)state;
    near(gained(two, 1, 0, 0, 1), 1);
    near(gained(two, 1, 0, 0, 5), 25);
    near(gained(two, 1, 4, -4, 5), 25); /* by depth, not by distance */
    near(gained(two + 1, 1, 0, 0, 5), 6.25);
    near(gained(two, 2, 0, 0, 5), 6.25); /* the one that resolves more */
    two[1].view.t[2] = 15;               /* from 20 away */
    near(gained(two, 2, 0, 0, 5), 25);
}

/* Behind a camera or beside its picture: the distance counts, but only if nobody sees it. */
static void test_unseen(void **state)
{
    ted4_listed_camera two[2] = { ahead(100), ahead(100) };

    (void)state;
    near(gained(two, 1, 0, 0, -2), 4);
    near(gained(two, 1, 6, 0, 2), 40);
    near(gained(two, 1, 2.5f, 0, 2), 4); /* within 1.3 half pictures */
    two[1].view.t[2] = 8;                /* this one sees it at depth 6 */
    near(gained(two, 2, 0, 0, -2), 36);
}

/* A camera so far away that its pixel has no width in binary32 leaves scales as they are. */
static void test_too_far(void **state)
{
    ted4_listed_camera camera = ahead(1e-6f);
    const ted4_camera_list taken = { .camera = &camera, .n = 1 };
    const float zero = 0.0f, *const mean[3] = { &zero, &zero, &zero };
    float s[3] = { 1.0f, 2.0f, 3.0f };

    (void)state;
    camera.view.t[2] = 3e38f;
    assert_int_equal(ted4_widen(&taken, 0.02f, 1, mean, (float *const[3]) { &s[0], &s[1], &s[2] }),
                     0);
    assert_true(s[0] == 1.0f && s[1] == 2.0f && s[2] == 3.0f);
}

static ted4_view before_scene(const ted4_info *info)
{
    ted4_view v = ahead(SIDE).view;

    v.width = v.height = SIDE;
    v.cx = v.cy = SIDE / 2;
    for (int k = 0; k < 3; k++)
        v.t[k] = (float)(-(double)info->origin[k] + (k == 2 ? ldexp(2.5, info->exponent) : 0.0));
    return v;
}

static double psnr(const uint8_t *a, const uint8_t *b)
{
    double error = 0.0;

    for (size_t i = 0; i < (size_t)LARGE * LARGE * 3; i++)
        error += (double)((a[i] - b[i]) * (a[i] - b[i]));
    return 10.0 * log10(255.0 * 255.0 * LARGE * LARGE * 3 / error);
}

/* A viewer that adds 0.3 pixels of its own draws widened Gaussians nearly as annex I.4 draws those
 * that are not. */
static void test_pictures(void **state)
{
    const ted4_info *const info = &file[1].info;
    ted4_viewer *const viewer = ted4_viewer_new();
    ted4_listed_camera taken = { .view = before_scene(info) };
    const ted4_camera_list list = { .camera = &taken, .n = 1 };
    ted4_view large = taken.view;
    uint8_t *rgb[3]; /* as decoded, by annex I.4, widened */
    ted4_gaussians g;

    (void)state;
    need_programs();
    assert_non_null(viewer);
    large.width = large.height = LARGE;
    large.fx = large.fy = TIMES * taken.view.fx;
    large.cx = large.cy = LARGE / 2;
    assert_int_equal(ted4_query_for_view(file[1].recon, 1, 2, &large, NULL, &g), TED4_OK);
    for (int i = 0; i < 3; i++) {
        rgb[i] = malloc((size_t)LARGE * LARGE * 3);
        assert_non_null(rgb[i]);
        large.pixel = i == 1 ? 1.0f / TIMES : 1.0f;
        float *scale[3];

        for (int k = 0; k < 3; k++) {
            scale[k] = malloc(g.n * sizeof *scale[k]);
            assert_non_null(scale[k]);
            memcpy(scale[k], g.scale[k], g.n * sizeof *scale[k]);
        }
        if (i == 2) {
            const float *const mean[3] = { g.mean[0], g.mean[1], g.mean[2] };

            assert_int_equal(ted4_widen(&list, 0.0f, g.n, mean, scale), 0);
        }
        ted4_gaussians drawn = g;
        for (int k = 0; k < 3; k++)
            drawn.scale[k] = scale[k];
        assert_int_equal(ted4_render_gaussians(viewer, &drawn, info, &large, NULL, rgb[i]),
                         TED4_OK);
        for (int k = 0; k < 3; k++)
            free(scale[k]);
    }
    const double decoded = psnr(rgb[0], rgb[1]), widened = psnr(rgb[2], rgb[1]);

    print_message("as decoded %.1f dB, widened %.1f dB\n", decoded, widened);
    assert_true(widened > decoded + 10.0);
    for (int i = 0; i < 3; i++)
        free(rgb[i]);
    ted4_viewer_free(viewer);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_width),
        cmocka_unit_test(test_unseen),
        cmocka_unit_test(test_too_far),
        cmocka_unit_test(test_pictures),
    };

    return cmocka_run_group_tests(tests, setup, teardown);
}
