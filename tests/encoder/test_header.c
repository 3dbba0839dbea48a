/* test_header.c - the header of the future file, made from the options and the scene: the frame
 * rate as a fraction, rows of the bank, and that no training begins with a header that the format
 * does not allow.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "test.h"
#include "cloud_case.h"
#include "data/frame_rate.h"
#include "train/model/header_from_options.h"
#include "train/step/trainer_init.h"

/* ---- frame rate ---- */

static void expect_rate(double rate, uint32_t num, uint32_t den)
{
    uint32_t n = 0, d = 0;

    assert_int_equal(ted4_frame_rate(rate, &n, &d), 0);
    if (n != num || d != den)
        fail_msg("%.17g: %u/%u, expected %u/%u", rate, (unsigned)n, (unsigned)d, (unsigned)num,
                 (unsigned)den);
}

static void test_rates(void **state)
{
    static const double none[] = { 0, -30, 5.9e-8, 16777215.5, 1e300, NAN, INFINITY };
    uint32_t n, d;

    (void)state;
    expect_rate(30, 30000, 1000);
    expect_rate(23.976, 23976, 1000);
    expect_rate(0.001, 1, 1000);
    expect_rate(16777.215, 16777215, 1000);
    expect_rate(30000.0 / 1001, 30000, 1001);
    expect_rate(1.0 / 60, 1, 60);
    expect_rate(0.0004, 1, 2500);
    expect_rate(20000, 20000, 1);
    expect_rate(20000.5, 40001, 2);
    expect_rate(16777215, 16777215, 1);
    expect_rate(1.0 / 16777215, 1, 16777215);
    for (size_t i = 0; i < sizeof none / sizeof none[0]; i++)
        assert_int_equal(ted4_frame_rate(none[i], &n, &d), -1);
}

/* Every rate between the bounds has a fraction whose relative error is at most 1e-7. */
static void test_any_rate(void **state)
{
    (void)state;
    for (uint64_t i = 0; i < 100000; i++) {
        const double rate = exp2(48 * ted4_uniform(7, i) - 24);
        uint32_t n, d;

        if (rate < 1.0 / TED4_RATE_MOST || rate > TED4_RATE_MOST)
            continue;
        assert_int_equal(ted4_frame_rate(rate, &n, &d), 0);
        assert_true(n >= 1);
        assert_true(n <= TED4_RATE_MOST);
        assert_true(d >= 1);
        assert_true(d <= TED4_RATE_MOST);
        if (!(fabs((double)n / d - rate) <= 1e-7 * rate))
            fail_msg("%.17g: %u/%u", rate, (unsigned)n, (unsigned)d);
    }
}

/* ---- when training begins ---- */

static void test_begin(void **state)
{
    static cloud_case c;
    ted4_trainer t;

    (void)state;
    cloud_make(&c, 5);
    assert_int_equal(ted4_trainer_init(&t, &c.options, &c.data, NULL), 0);
    assert_int_equal(t.layout.head.rate_num, 30);
    assert_int_equal(t.layout.head.rate_den, 1);
    ted4_trainer_finish(&t);
    c.data.rate = 1.0 / 60;
    assert_int_equal(ted4_trainer_init(&t, &c.options, &c.data, NULL), 0);
    assert_int_equal(t.layout.head.rate_num, 1);
    assert_int_equal(t.layout.head.rate_den, 60);
    ted4_trainer_finish(&t);
    /* Loaders would reject both. */
    c.data.rate = 1e9;
    assert_int_equal(ted4_trainer_init(&t, &c.options, &c.data, NULL), -1);
    assert_non_null(strstr(t.message.text, "rate_num is beyond its range"));
    ted4_trainer_finish(&t);
    c.data.rate = 0;
    c.options.feature = 129;
    assert_int_equal(ted4_trainer_init(&t, &c.options, &c.data, NULL), -1);
    assert_non_null(strstr(t.message.text, "feature_dim is beyond its range"));
    ted4_trainer_finish(&t);
}

/* ---- rows of the bank ---- */

static void test_rows(void **state)
{
    static const uint32_t want[][2] = {
        { 2, 2 }, { 3, 2 }, { 4, 2 }, { 5, 3 }, { 16, 8 }, { 17, 9 }
    };
    static cloud_case c;
    ted4_header h;

    (void)state;
    for (int motion = TED4_MOTION_BANK; motion <= TED4_MOTION_CONCAT; motion++)
        for (size_t i = 0; i < sizeof want / sizeof want[0]; i++) {
            cloud_make(&c, want[i][0]);
            c.options.motion = motion;
            ted4_header_make(&h, &c.options, &c.data);
            assert_int_equal(h.bank_rows, want[i][1]);
            c.options.bank_rows = 1;
            ted4_header_make(&h, &c.options, &c.data);
            assert_int_equal(h.bank_rows, 1);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_rates),
        cmocka_unit_test(test_any_rate),
        cmocka_unit_test(test_begin),
        cmocka_unit_test(test_rows),
    };

    return cmocka_run_group_tests_name("header", tests, NULL, NULL);
}
