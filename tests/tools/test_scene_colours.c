/* test_scene_colours.c - scenes of the lab whose cameras differ in colour: their tints, exposures
 * that drift over time, and test pictures of the training cameras.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "test.h"
#include "larger.h"
#include "tools/scene/ray_rig.h"
#include "tools/scene/ray_shot.h"

enum { W = 48, H = 32, AREA = W * H, SIZE = 3 * AREA };

static ted4_ray_options plan(ted4_ray_scene s)
{
    ted4_ray_options o = ted4_ray_defaults(s);

    o.width = W;
    o.height = H;
    return o;
}

/* The picture as it is written, without alpha. */
static void shot(const ted4_ray_options *o, int number, int frame, uint8_t *rgb)
{
    static uint8_t rgba[4 * AREA];

    ted4_ray_shot(o, number, frame, rgba);
    for (int i = 0; i < AREA; i++)
        memcpy(rgb + 3 * i, rgba + 4 * i, 3);
}

/* Returns the share of bytes that differ by more than limit. */
static double changed(const uint8_t *a, const uint8_t *b, int limit)
{
    int n = 0;

    for (int i = 0; i < SIZE; i++)
        n += abs(a[i] - b[i]) > limit;
    return (double)n / SIZE;
}

static double brightness(const uint8_t *rgb)
{
    double sum = 0;

    for (int i = 0; i < SIZE; i++)
        sum += rgb[i];
    return sum / SIZE;
}

static void test_tints(void **state)
{
    const ted4_ray_options o = plan(RAY_TINTS);
    ted4_ray_options plain = o;
    static uint8_t a[SIZE], b[SIZE];
    double least = 9, most = 0, mean[9] = { 0 };

    (void)state;
    plain.tint = 0;
    for (int camera = 0; camera < o.n_train; camera++) {
        ted4_ray_camera c;
        shot(&o, camera, 0, a);
        shot(&plain, camera, 0, b);
        const double share = brightness(a) / brightness(b);
        least = fmin(least, share);
        most = larger(most, share);
        assert_true(changed(a, b, 4) > 0.3);
        ted4_ray_camera_of(&o, camera, &c);
        for (int i = 0; i < 9; i++)
            mean[i] += (double)c.colour[i] / o.n_train;
    }
    assert_true(most / least > 1.3);
    for (int i = 0; i < 9; i++)
        assert_true(fabs(mean[i] - (i % 4 == 0)) < 1e-6);
    shot(&o, o.n_train, 0, a);
    shot(&plain, o.n_train, 0, b);
    assert_memory_equal(a, b, SIZE);
}

/* Exposures change by half a stop each, and by nothing in the mean. */
static void test_dusk(void **state)
{
    ted4_ray_options o = plan(RAY_DUSK), plain = o;
    static uint8_t a[SIZE], b[SIZE];

    (void)state;
    plain.drift = 0;
    for (; o.n_train >= 5; o.n_train--)
        for (int frame = 0; frame < o.n_frames; frame++) {
            double product = 1;

            for (int camera = 0; camera < o.n_train; camera++)
                product *= ted4_ray_exposure(&o, camera, frame);
            assert_true(fabs(product - 1) < 1e-12);
        }
    o.n_train = 6;
    for (int camera = 0; camera < o.n_train; camera++) {
        const double first = ted4_ray_exposure(&o, camera, 0),
                     last = ted4_ray_exposure(&o, camera, o.n_frames - 1);

        assert_true(fabs(first * last - 1) < 1e-12);
        assert_true(fabs(fabs(log2(first / last)) - 0.5) < 1e-12);
        for (int frame = 0; frame < o.n_frames; frame += o.n_frames - 1) {
            shot(&o, camera, frame, a);
            shot(&plain, camera, frame, b);
            if (ted4_ray_exposure(&o, camera, frame) > 1)
                assert_true(brightness(a) > 1.02 * brightness(b));
            else
                assert_true(brightness(a) < 0.98 * brightness(b));
        }
    }
    shot(&o, o.n_train, 0, a);
    shot(&plain, o.n_train, 0, b);
    assert_memory_equal(a, b, SIZE);
}

/* The test pictures are those that the training cameras did not take. */
static void test_tints4(void **state)
{
    ted4_ray_options o = plan(RAY_TINTS4);
    static uint8_t a[SIZE], b[SIZE];

    (void)state;
    for (int camera = 0; camera < o.n_train; camera++)
        for (int frame = 0; frame < o.n_frames; frame++) {
            assert_int_equal(ted4_ray_is_taken(&o, camera, frame), frame % 8 != 4);
            assert_int_equal(ted4_ray_is_taken(&o, o.n_train + camera, frame), frame % 8 == 4);
            if (frame % 8 != 4)
                continue;
            shot(&o, camera, frame, a);
            shot(&o, o.n_train + camera, frame, b);
            assert_memory_equal(a, b, SIZE);
        }
    o.layout = RAY_COLMAP;
    assert_int_equal(ted4_ray_is_taken(&o, o.n_train, 3), 1);
    shot(&o, 0, 3, a);
    shot(&o, o.n_train, 3, b);
    assert_true(changed(a, b, 4) > 0.3);
}

int main(void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test(test_tints), cmocka_unit_test(test_dusk),
                                        cmocka_unit_test(test_tints4) };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
