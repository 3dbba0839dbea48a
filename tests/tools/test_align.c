/* test_align.c - tool/align.c on a cloud of Gaussians: the pose of a camera that is some pixels
 * wrong is found, one that is right stays as it is, and the half that is judged has no influence.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "larger.h"
#include "pose_ref.h"
#include "random_source.h"
#include "test.h"
#include "render/raster.h"
#include "tool/align.h"
#include "tool/camera_view.h"

enum { WIDTH = 96, HEIGHT = 64, N = 200, FOCAL = 96 };

#define DISTANCE 4.0

static float value[14][N];
static float image[3 * WIDTH * HEIGHT];
static uint8_t truth[3 * WIDTH * HEIGHT], ours[3 * WIDTH * HEIGHT];
static ted4_raster *raster;
static int draws, fail_at;

static const ted4_camera right = {
    WIDTH, HEIGHT, FOCAL, FOCAL, 48, 32, { 1, 0, 0, 0, 1, 0, 0, 0, 1 }, { 0, 0, DISTANCE }
};

static int draw(void *user, const ted4_camera *c, uint8_t *rgb)
{
    const ted4_splats s = { N,
                            { value[0], value[1], value[2] },
                            { value[3], value[4], value[5] },
                            { value[6], value[7], value[8], value[9] },
                            value[10],
                            { value[11], value[12], value[13] } };
    ted4_view v = ted4_view_of_camera(c);

    (void)user;
    if (++draws == fail_at)
        return 7;
    v.near_z = 0.02f;
    assert_int_equal(ted4_raster_forward(raster, &s, &v, NULL, 0, image), 0);
    for (size_t i = 0; i < WIDTH * HEIGHT; i++)
        for (size_t k = 0; k < 3; k++)
            rgb[3 * i + k] =
                (uint8_t)(fminf(fmaxf(image[k * WIDTH * HEIGHT + i], 0), 1) * 255 + 0.5f);
    return 0;
}

static int set_up(void **state)
{
    random_source r = random_seed(5);

    (void)state;
    for (int i = 0; i < N; i++) {
        for (int k = 0; k < 3; k++) {
            value[k][i] = random_float(&r, -1.5f, 1.5f);
            value[3 + k][i] = random_float(&r, 0.05f, 0.3f);
            value[11 + k][i] = random_float(&r, 0, 1);
        }
        value[6][i] = 1;
        value[10][i] = 0.8f;
    }
    raster = ted4_raster_new();
    return raster == NULL || draw(NULL, &right, truth) != 0;
}

static int tear_down(void **state)
{
    (void)state;
    ted4_raster_free(raster);
    return 0;
}

/* Moves a camera by a rotation vector and a translation, in its own axes. */
static ted4_camera moved(const double motion[6])
{
    ted4_camera c = right;
    double turn[9];

    ref_exponential(motion, turn);
    ref_product(turn, right.R, c.R);
    for (int i = 0; i < 3; i++)
        c.t[i] = turn[3 * i] * right.t[0] + turn[3 * i + 1] * right.t[1] +
                 turn[3 * i + 2] * right.t[2] + motion[3 + i];
    return c;
}

/* Returns the most pixels between where two cameras see the corners of a cube in the scene. */
static double apart(const ted4_camera *a, const ted4_camera *b)
{
    double most = 0;

    for (int corner = 0; corner < 8; corner++) {
        const double x[3] = { corner & 1 ? 1 : -1, corner & 2 ? 0.7 : -0.7, corner & 4 ? 1 : -1 };
        const ted4_camera *c[2] = { a, b };
        double at[2][2];

        for (int k = 0; k < 2; k++) {
            double y[3];

            for (int i = 0; i < 3; i++)
                y[i] = c[k]->R[3 * i] * x[0] + c[k]->R[3 * i + 1] * x[1] +
                       c[k]->R[3 * i + 2] * x[2] + c[k]->t[i];
            at[k][0] = FOCAL * y[0] / y[2];
            at[k][1] = FOCAL * y[1] / y[2];
        }
        most = larger(most, hypot(at[0][0] - at[1][0], at[0][1] - at[1][1]));
    }
    return most;
}

static double psnr_from(const ted4_camera *c)
{
    assert_int_equal(draw(NULL, c, ours), 0);
    return ted4_align_psnr(truth, ours, WIDTH, HEIGHT);
}

static void test_wrong(void **state)
{
    static const double wrong[][6] = {
        { 0.03, 0, 0, 0, 0, 0 },
        { 0, -0.04, 0, 0, 0, 0 },
        { 0, 0, 0.05, 0, 0, 0 },
        { 0, 0, 0, 0.1, -0.1, 0.2 },
        { 0.01, 0.02, -0.02, 0.05, 0, -0.1 },
    };

    (void)state;
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        const ted4_camera given = moved(wrong[i]);
        ted4_camera aligned;

        assert_true(apart(&given, &right) > 1);
        assert_int_equal(ted4_align(&given, DISTANCE, truth, draw, NULL, &aligned), 0);
        assert_true(apart(&aligned, &right) < 0.05);
        assert_true(psnr_from(&given) < 30);
        assert_true(psnr_from(&aligned) > 45);
        assert_int_equal(aligned.width, WIDTH);
        assert_true(aligned.fx == FOCAL);
    }
}

/* From the true pose nothing moves, even if the picture shows more than the scene has. */
static void test_right(void **state)
{
    static uint8_t before[sizeof truth];
    ted4_camera aligned;

    (void)state;
    assert_int_equal(ted4_align(&right, DISTANCE, truth, draw, NULL, &aligned), 0);
    assert_memory_equal(&aligned, &right, sizeof right);
    assert_true(isinf(psnr_from(&right)));

    memcpy(before, truth, sizeof truth);
    random_source r = random_seed(9);

    for (size_t i = 0; i < sizeof truth; i++)
        truth[i] = (uint8_t)fminf(fmaxf((float)truth[i] + random_float(&r, -9, 9), 0), 255);
    assert_int_equal(ted4_align(&right, DISTANCE, truth, draw, NULL, &aligned), 0);
    assert_true(apart(&aligned, &right) < 0.05);
    assert_true(fabs(psnr_from(&aligned) - psnr_from(&right)) < 0.05);
    memcpy(truth, before, sizeof truth);
}

/* What the judged half shows does not reach the fit, whatever the blur; it alone is judged. */
static void test_halves(void **state)
{
    static const double wrong[6] = { 0.02, -0.03, 0.01, 0, 0, 0.05 };
    static uint8_t before[sizeof truth];
    const ted4_camera given = moved(wrong);
    ted4_camera first, second;

    (void)state;
    assert_int_equal(ted4_align(&given, DISTANCE, truth, draw, NULL, &first), 0);
    memcpy(before, truth, sizeof truth);
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++)
            if ((x / TED4_ALIGN_TILE + y / TED4_ALIGN_TILE) % 2 == 1)
                memset(truth + 3 * (y * WIDTH + x), 0, 3);
    assert_int_equal(ted4_align(&given, DISTANCE, truth, draw, NULL, &second), 0);
    assert_memory_equal(&first, &second, sizeof first);
    assert_true(psnr_from(&second) < 20);
    memcpy(truth, before, sizeof truth);
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++)
            if ((x / TED4_ALIGN_TILE + y / TED4_ALIGN_TILE) % 2 == 0)
                memset(truth + 3 * (y * WIDTH + x), 0, 3);
    assert_true(isinf(psnr_from(&right)));
    memcpy(truth, before, sizeof truth);
}

/* Nothing to hold on to: the given pose stays. A failure to draw ends the fit. */
static void test_nothing(void **state)
{
    static uint8_t before[sizeof truth];
    const ted4_camera away = moved((const double[6]) { 0, 3.1, 0, 0, 0, 0 });
    ted4_camera aligned;

    (void)state;
    assert_int_equal(ted4_align(&away, DISTANCE, truth, draw, NULL, &aligned), 0);
    assert_memory_equal(&aligned, &away, sizeof away);

    memcpy(before, truth, sizeof truth);
    memset(truth, 0, sizeof truth);
    for (int at = 1; at < 20; at += 3) {
        draws = 0;
        fail_at = at;
        assert_int_equal(ted4_align(&right, DISTANCE, truth, draw, NULL, &aligned), 7);
        assert_int_equal(draws, at);
    }
    fail_at = 0;
    memcpy(truth, before, sizeof truth);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_wrong),
        cmocka_unit_test(test_right),
        cmocka_unit_test(test_halves),
        cmocka_unit_test(test_nothing),
    };

    return cmocka_run_group_tests_name("align", tests, set_up, tear_down);
}
