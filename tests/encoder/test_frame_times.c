/* test_frame_times.c - the frames of times in any unit (data/frame_times.c).
 * SPDX-License-Identifier: BSD-2-Clause */
#include <math.h>

#include "test.h"
#include "data/raw_scene.h"

static void test_times(void **state)
{
    (void)state;
    ted4_message m;
    double t[400];
    uint32_t frame[400], n;

    /* Uniform, in another unit, not in order, with six digits. */
    for (int i = 0; i < 7; i++)
        t[i] = 100 + 1e-6 * round(1e6 * ((i * 3) % 7) / 3.0);
    assert_int_equal(ted4_frame_times(t, 7, frame, &n, &m), 0);
    assert_int_equal(n, 7);
    for (uint32_t i = 0; i < 7; i++)
        assert_int_equal(frame[i], i * 3 % 7);
    /* One frame is missing. */
    const double gap[4] = { 0, 1, 2, 4 };
    assert_int_equal(ted4_frame_times(gap, 4, frame, &n, &m), 0);
    assert_int_equal(n, 5);
    assert_int_equal(frame[3], 4);
    /* Three frames of six: the grid's step is finer than the smallest gap. */
    const double three[3] = { 0, 2, 5 };
    assert_int_equal(ted4_frame_times(three, 3, frame, &n, &m), 0);
    assert_int_equal(n, 6);
    assert_int_equal(frame[1], 2);
    /* D-NeRF: 150 training times, 20 test times; the common grid has 149 * 19 steps. */
    for (int i = 0; i < 170; i++)
        t[i] = i < 150 ? i / 149.0 : (i - 150) / 19.0;
    assert_int_equal(ted4_frame_times(t, 170, frame, &n, &m), 0);
    assert_int_equal(n, 149 * 19 + 1);
    assert_int_equal(frame[1], 19);
    assert_int_equal(frame[151], 149);
    /* No common step: each time goes to the nearest position on a grid whose step is the smallest
     * gap. */
    const double odd[4] = { 0, 0.137, 0.5237, 1 };
    assert_int_equal(ted4_frame_times(odd, 4, frame, &n, &m), 0);
    assert_true(n >= 8);
    assert_true(n <= 33);
    for (int i = 0; i < 4; i++)
        assert_true(fabs(frame[i] / (n - 1.0) - odd[i]) <= 0.5 / (n - 1.0));
    /* The grid would be too fine. */
    const double close[3] = { 0, 1e-5, 1 };
    assert_int_equal(ted4_frame_times(close, 3, frame, &n, &m), 0);
    assert_int_equal(n, TED4_MAX_FRAMES);
    assert_int_equal(frame[0], 0);
    assert_int_equal(frame[1], 0);
    assert_int_equal(frame[2], TED4_MAX_FRAMES - 1);
    const double one[2] = { 5, 5 };
    assert_int_equal(ted4_frame_times(one, 2, frame, &n, &m), 0);
    assert_int_equal(n, 1);
    assert_int_equal(frame[1], 0);
}

/* One of 1501 times is missing, near either end, or in the middle. */
static void test_long_times(void **state)
{
    enum { N = 1500 };
    static const uint32_t missing[] = { 1, 101, 750, 1499 };
    static double t[N];
    static uint32_t frame[N];

    (void)state;
    for (size_t k = 0; k < sizeof missing / sizeof missing[0]; k++) {
        ted4_message m;
        uint32_t n;
        for (uint32_t i = 0; i < N; i++)
            t[i] = (i + (i >= missing[k])) / 30.0;
        assert_int_equal(ted4_frame_times(t, N, frame, &n, &m), 0);
        assert_int_equal(n, N + 1);
        for (uint32_t i = 0; i < N; i++)
            assert_int_equal(frame[i], i + (i >= missing[k]));
    }
}

/* Times that were rounded to two digits go to the frames from which they were rounded, whether one
 * is missing or not. */
static void test_rounded(void **state)
{
    enum { N = 16 };
    ted4_message m;
    uint32_t frame[N], n;
    double t[N];

    (void)state;
    for (int missing = 1; missing < N; missing++) {
        int k = 0;
        for (int i = 0; i < N; i++)
            if (i != missing || missing == N - 1)
                t[k++] = round(100.0 * i / (N - 1)) / 100;
        assert_int_equal(ted4_frame_times(t, (size_t)k, frame, &n, &m), 0);
        assert_int_equal(n, N);
        for (int i = 0; i < k; i++)
            assert_int_equal(frame[i], i + (i >= missing && missing < N - 1));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_times),
        cmocka_unit_test(test_long_times),
        cmocka_unit_test(test_rounded),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
