/* test_elementary.c - math/elementary.h: accuracy over the whole range against libm's long double
 * functions, where long double has more bits; special arguments; and the exact bits.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "test.h"
#include "larger.h"
#include "math/elementary.h"
#include "train/math/random.h"

typedef long double (*long_function)(long double);
typedef double (*our_function)(double);

enum { POINTS = 400000 };

/* Largest relative error of f at POINTS random points: uniform in [from, to], or, if spread != 0,
 * with uniform logarithms and both signs, where from = 2^-spread. */
static double worst_of(our_function f, long_function truth, double from, double to, double spread)
{
    double worst = 0;

    for (uint64_t i = 0; i < POINTS; i++) {
        const double u = (double)ted4_mix(i) * 0x1p-64, v = (double)ted4_mix(i ^ 0x5555u) * 0x1p-64;
        const double of_one = from < 0 && (i & 1) ? -1 - v : 1 + v;
        const double x = spread != 0 ? ldexp(of_one, (int)(spread * (2 * u - 1)))
                                     : from + u * (to - from);
        const long double y = truth((long double)x);

        if (!(fabsl(y) >= DBL_MIN && fabsl(y) <= DBL_MAX))
            continue;
        worst = larger(worst, (double)fabsl(((long double)f(x) - y) / y));
    }
    return worst;
}

static void assert_within(const char *what, double worst, double bound)
{
    print_message("%s: largest relative error %.3g\n", what, worst);
    assert_true(worst <= bound);
}

static void test_errors(void **state)
{
    (void)state;
    assert_within("exp, whole range", worst_of(ted4_math_exp, expl, -746, 711, 0), 4e-16);
    assert_within("exp, of all sizes", worst_of(ted4_math_exp, expl, -1, 1, 60), 4e-16);
    assert_within("exp2, whole range", worst_of(ted4_math_exp2, exp2l, -1080, 1030, 0), 4e-16);
    assert_within("exp2, of all sizes", worst_of(ted4_math_exp2, exp2l, -1, 1, 60), 4e-16);
    assert_within("log, of all sizes", worst_of(ted4_math_log, logl, 1, 1, 1020), 4e-16);
    assert_within("log, near 1", worst_of(ted4_math_log, logl, 0.5, 2, 0), 4e-16);
    assert_within("log2, of all sizes", worst_of(ted4_math_log2, log2l, 1, 1, 1020), 4e-16);
    assert_within("log2, near 1", worst_of(ted4_math_log2, log2l, 0.5, 2, 0), 4e-16);
    assert_within("sin, usual", worst_of(ted4_math_sin, sinl, -7, 7, 0), 4e-16);
    assert_within("sin, large", worst_of(ted4_math_sin, sinl, -1e5, 1e5, 0), 4e-16);
    assert_within("sin, small", worst_of(ted4_math_sin, sinl, -1, 1, 16), 4e-16);
    assert_within("tan, usual", worst_of(ted4_math_tan, tanl, -7, 7, 0), 6e-16);
    assert_within("tan, large", worst_of(ted4_math_tan, tanl, -1e5, 1e5, 0), 6e-16);
}

static void test_error_of_pow(void **state)
{
    double worst = 0;

    (void)state;
    for (uint64_t i = 0; i < POINTS; i++) {
        const double u = (double)ted4_mix(i) * 0x1p-64, v = (double)ted4_mix(i ^ 0x5555u) * 0x1p-64;
        const double x = exp2(200 * u - 100), y = i % 3 == 0 ? floor(1000 * v) : 20 * v - 10;
        const long double truth = powl((long double)x, (long double)y);

        if (!(truth >= DBL_MIN && truth <= DBL_MAX))
            continue;

        const double error = (double)fabsl(((long double)ted4_math_pow(x, y) - truth) / truth);

        worst = larger(worst, error / (2 + fabs(y * log2(x))));
    }
    assert_within("pow, by 2 + |y log2(x)|", worst, 3e-16);
}

static void test_exact(void **state)
{
    (void)state;
    for (int e = -1074; e <= 1023; e++) {
        assert_true(ted4_math_exp2(e) == ldexp(1, e));
        assert_true(ted4_math_log2(ldexp(1, e)) == e);
    }
    for (int k = 0; k < 60; k++)
        assert_true(ted4_math_pow(0.5, k) == ldexp(1, -k));
    assert_true(ted4_math_exp(0) == 1);
    assert_true(ted4_math_exp2(-0.0) == 1);
    assert_true(ted4_math_log(1) == 0);
    assert_true(ted4_math_log2(1) == 0);
    assert_true(ted4_math_sin(0) == 0);
    assert_true(ted4_math_tan(0) == 0);
    assert_true(ted4_math_sin(-1) == -ted4_math_sin(1));
    assert_true(ted4_math_tan(-1) == -ted4_math_tan(1));
    for (int c = 1; c < 128; c++) {
        const float x = (float)c * 0.0625f;

        assert_true(fabsf(ted4_math_expf(x) / expf(x) - 1) <= 2 * FLT_EPSILON);
        assert_true(fabsf(ted4_math_exp2f(x) / exp2f(x) - 1) <= 2 * FLT_EPSILON);
        assert_true(c == 16 || fabsf(ted4_math_log2f(x) / log2f(x) - 1) <= 2 * FLT_EPSILON);
        assert_true(fabsf(ted4_math_sinf(x) / sinf(x) - 1) <= 2 * FLT_EPSILON);
    }
}

static void test_awkward(void **state)
{
    const double inf = (double)INFINITY, nan = (double)NAN, tiny = 0x1p-1074;

    (void)state;
    assert_true(ted4_math_exp(inf) == inf);
    assert_true(ted4_math_exp(-inf) == 0);
    assert_true(isnan(ted4_math_exp(nan)));
    assert_true(ted4_math_exp(1e300) == inf);
    assert_true(ted4_math_exp(-1e300) == 0);
    assert_true(ted4_math_exp(710) == inf);
    assert_true(ted4_math_exp(-746) == 0);
    assert_true(ted4_math_exp(tiny) == 1);
    assert_true(ted4_math_exp(-745.1) == tiny);
    assert_true(ted4_math_exp2(inf) == inf);
    assert_true(ted4_math_exp2(-inf) == 0);
    assert_true(isnan(ted4_math_exp2(nan)));
    assert_true(ted4_math_exp2(1e300) == inf);
    assert_true(ted4_math_exp2(-1e300) == 0);
    assert_true(ted4_math_exp2(1024) == inf);
    assert_true(ted4_math_exp2(-1076) == 0);
    assert_true(ted4_math_log(0) == -inf);
    assert_true(ted4_math_log(-0.0) == -inf);
    assert_true(ted4_math_log(inf) == inf);
    assert_true(isnan(ted4_math_log(-1)));
    assert_true(isnan(ted4_math_log(-inf)));
    assert_true(isnan(ted4_math_log(nan)));
    assert_true(isnan(ted4_math_log2(-tiny)));
    assert_true(ted4_math_log2(0) == -inf);
    assert_true(ted4_math_log2(inf) == inf);
    assert_true(isnan(ted4_math_log2(nan)));
    assert_true(fabs(ted4_math_log(3 * tiny) - log(3 * tiny)) < 1e-12);
    assert_true(fabs(ted4_math_log(DBL_MAX) - log(DBL_MAX)) < 1e-12);
    assert_true(ted4_math_pow(0, 2) == 0);
    assert_true(ted4_math_pow(0, -1) == inf);
    assert_true(ted4_math_pow(0, 0) == 1);
    assert_true(ted4_math_pow(inf, 0) == 1);
    assert_true(ted4_math_pow(1, inf) == 1);
    assert_true(ted4_math_pow(2, inf) == inf);
    assert_true(ted4_math_pow(0.5, inf) == 0);
    assert_true(ted4_math_pow(inf, -1) == 0);
    assert_true(isnan(ted4_math_pow(-2, 2)));
    assert_true(isnan(ted4_math_pow(nan, 1)));
    assert_true(isnan(ted4_math_pow(2, nan)));
    assert_true(isnan(ted4_math_pow(1.5, nan)));
    assert_true(ted4_math_pow(0.999, 1e9) == 0);
    assert_true(ted4_math_pow(1e300, 2) == inf);
    assert_true(isnan(ted4_math_sin(inf)));
    assert_true(isnan(ted4_math_sin(nan)));
    assert_true(isnan(ted4_math_sin(1e6)));
    assert_true(isnan(ted4_math_tan(-inf)));
    assert_true(isinf(ted4_math_exp2f(130)));
    assert_true(ted4_math_exp2f(-160) == 0);
    assert_true(ted4_math_exp2f(-149) == 0x1p-149f);
}

/* A hash of 4096 results of each function, which every compiler, level and machine must
 * reproduce. */
static void test_bits(void **state)
{
    const our_function f[] = { ted4_math_exp,  ted4_math_exp2, ted4_math_log,
                               ted4_math_log2, ted4_math_sin,  ted4_math_tan };
    uint64_t hash = 0, bits;

    (void)state;
    for (size_t k = 0; k < sizeof f / sizeof *f; k++)
        for (int i = 1; i <= 4096; i++) {
            const double y = f[k]((double)i * 0x1.921p-7);

            memcpy(&bits, &y, sizeof bits);
            hash = ted4_mix(hash ^ bits);
        }
    for (int i = 1; i <= 4096; i++) {
        const double y = ted4_math_pow(i * 0x1.7p-8, i * 0x1.3p-10 - 2);

        memcpy(&bits, &y, sizeof bits);
        hash = ted4_mix(hash ^ bits);
    }
    print_message("hash of results %016llx\n", (unsigned long long)hash);
    assert_int_equal(hash, 0xd661afac48b9d642u);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_errors), cmocka_unit_test(test_error_of_pow),
        cmocka_unit_test(test_exact),  cmocka_unit_test(test_awkward),
        cmocka_unit_test(test_bits),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
