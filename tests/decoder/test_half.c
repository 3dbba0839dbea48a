/* test_half.c - norm/half.h: conversions, exact integers, sort keys (spec 8).
 * SPDX-License-Identifier: BSD-2-Clause */
#include <math.h>

#include "test.h"
#include "norm/half.h"
#include "random_scene.h"

/* The value of a finite pattern, from its definition. */
static double value(unsigned h)
{
    const int e = h >> 10 & 31;
    const double m = h & 0x3ff;
    const double x = e > 0 ? ldexp(1024 + m, e - 25) : ldexp(m, -24);

    return h >> 15 ? -x : x;
}

static void to_float(void **state)
{
    (void)state;
    for (unsigned h = 0; h < 65536; h++) {
        const float x = ted4_half_to_float((uint16_t)h);

        if ((h & 0x7c00) == 0x7c00) {
            assert_true(h & 0x3ff ? isnan(x) : isinf(x));
            continue;
        }
        assert_true((double)x == value(h));
        assert_int_equal(signbit(x) != 0, h >> 15);
        assert_int_equal(ted4_float_to_half(x), h);
        if (fabs(value(h)) <= 1)
            assert_true(ted4_half_q24((uint16_t)h) == ldexp(value(h), 24));
    }
}

/* A number between two neighbours is rounded to the nearer one, and one in the middle to the even
 * one. */
static void from_float(void **state)
{
    (void)state;
    for (unsigned h = 0; h < 0x7bff; h++) {
        const double a = value(h), b = value(h + 1), middle = (a + b) / 2;
        const unsigned even = h & 1 ? h + 1 : h;

        assert_int_equal(ted4_float_to_half((float)middle), even);
        assert_int_equal(ted4_float_to_half(-(float)middle), even | 0x8000);
        assert_int_equal(ted4_float_to_half(nextafterf((float)middle, 0)), h);
        assert_int_equal(ted4_float_to_half(nextafterf((float)middle, 1e9f)), h + 1);
    }
    assert_int_equal(ted4_float_to_half(65520), 0x7c00);
    assert_int_equal(ted4_float_to_half(nextafterf(65520, 0)), 0x7bff);
    assert_int_equal(ted4_float_to_half(1e30f), 0x7c00);
    assert_int_equal(ted4_float_to_half(-INFINITY), 0xfc00);
    assert_int_equal(ted4_float_to_half(NAN) & 0x7e00, 0x7e00);
    assert_int_equal(ted4_float_to_half(1e-30f), 0);
    assert_int_equal(ted4_float_to_half(-0.0f), 0x8000);
}

static void order(void **state)
{
    (void)state;
    for (unsigned h = 0; h + 1 < 0x7c00; h++) {
        assert_true(ted4_half_order((uint16_t)h) < ted4_half_order((uint16_t)(h + 1)));
        assert_true(ted4_half_order((uint16_t)(h | 0x8000)) >
                    ted4_half_order((uint16_t)((h + 1) | 0x8000)));
    }
    assert_true(ted4_half_order(0x8001) < ted4_half_order(0));
}

static void morton(void **state)
{
    random_source r = random_seed(1);

    (void)state;
    for (int n = 0; n < 10000; n++) {
        uint16_t p[3];
        uint64_t code = 0;

        for (int j = 0; j < 3; j++)
            p[j] = (uint16_t)random_u32(&r);
        for (unsigned i = 0; i < 16; i++)
            for (unsigned j = 0; j < 3; j++)
                code |= (uint64_t)(ted4_half_order(p[j]) >> i & 1) << (3 * i + 2 - j);
        assert_int_equal(ted4_morton(p), code);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(to_float),
        cmocka_unit_test(from_float),
        cmocka_unit_test(order),
        cmocka_unit_test(morton),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
