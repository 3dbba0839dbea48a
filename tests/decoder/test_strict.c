/* test_strict.c - spec 12.2: pow2 and its limits, and the class X probe under each way of breaking
 * the arithmetic.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <fenv.h>

#include "test.h"
#include "larger.h"
#include "recon/strict.h"
#include "ted4.h"
#if defined(__SSE__)
#include <xmmintrin.h>
#endif

/* All 2^25 arguments would take seconds; a step that is not a power of two covers all fractions. */
static void pow2_is_within_two_tenths_of_a_millionth(void **state)
{
    double worst = 0;

    (void)state;
    for (double x = -126; x <= 126; x += 0x1.23457p-12) {
        const float arg = (float)x;
        const double want = exp2((double)arg);
        const double error = fabs((double)ted4_pow2(arg) - want) / want;

        worst = larger(worst, error);
    }
    assert_true(worst < 2e-7);
    assert_true(worst > 1e-8); /* the measurement itself works */
}

static void pow2_of_whole_numbers_is_exact(void **state)
{
    (void)state;
    for (int n = -126; n <= 126; n++)
        assert_int_equal(ted4_float_bits(ted4_pow2((float)n)), (uint32_t)(n + 127) << 23);
}

static void pow2_is_clamped_and_keeps_nan(void **state)
{
    (void)state;
    assert_true(ted4_pow2(-126.5f) == 0x1p-126f);
    assert_true(ted4_pow2(-INFINITY) == 0x1p-126f);
    assert_true(ted4_pow2(126.5f) == 0x1p126f);
    assert_true(ted4_pow2(INFINITY) == 0x1p126f);
    assert_true(isnan(ted4_pow2(NAN)));
    assert_true(isnan(ted4_sigmoid(NAN)));
    assert_true(ted4_pow2(-0.0f) == 1);
    assert_true(ted4_pow2(0x1p-149f) == 1);
}

/* The code in the text of the specification, with floorf, around every change of n. */
static float pow2_of_the_text(float x)
{
    static const float c[7] = { 0x1.430912p-13f,
                                0x1.5d87fep-10f,
                                0x1.3b2ab6p-7f,
                                0x1.c6b08ep-5f,
                                0x1.ebfbep-3f,
                                0x1.62e43p-1f,
                                1.0f };
    x = x < -126.0f ? -126.0f : x > 126.0f ? 126.0f : x;
    const float n = floorf(x + 0.5f), f = x - n;
    float p = 0x1.ffcbfcp-17f;

    for (int i = 0; i < 7; i++)
        p = p * f + c[i];
    return p * ted4_bits_float((uint32_t)((int32_t)n + 127) << 23);
}

static void pow2_is_that_of_the_text(void **state)
{
    (void)state;
    for (int n = -254; n <= 254; n++)
        for (int i = -200; i <= 200; i++) {
            const float middle = (float)n / 2;
            const float x =
                ted4_bits_float(ted4_float_bits(middle) + (uint32_t)i * (i % 2 ? 1 : 977));

            if (x == x)
                assert_int_equal(ted4_float_bits(ted4_pow2(x)),
                                 ted4_float_bits(pow2_of_the_text(x)));
        }
}

static void sigmoid_is_near_real_numbers(void **state)
{
    (void)state;
    for (float x = -100; x <= 100; x += 0.0371f) {
        const double want = 1 / (1 + exp((double)-x)), got = (double)ted4_sigmoid(x);

        assert_true(fabs(got - want) < 1.5e-7);
    }
    assert_true(ted4_sigmoid(0) == 0.5f);
    assert_true(ted4_sigmoid(100) == 1.0f);
}

static void max_keeps_nan_of_its_second_argument(void **state)
{
    (void)state;
    assert_true(ted4_max(0, -1) == 0);
    assert_true(ted4_max(0, 1) == 1);
    assert_true(isnan(ted4_max(0, NAN)));
}

static void this_build_claims_class_x(void **state)
{
    (void)state;
    assert_true(ted4_strict_ok());
    assert_true(ted4_recon_class_x());
}

static void other_rounding_is_noticed(void **state)
{
    static const int modes[] = { FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO };

    (void)state;
    for (int i = 0; i < 3; i++) {
        assert_int_equal(fesetround(modes[i]), 0);
        const int ok = ted4_strict_ok();

        assert_int_equal(fesetround(FE_TONEAREST), 0);
        assert_false(ok);
    }
    assert_true(ted4_strict_ok());
}

static void flushing_is_noticed(void **state)
{
    (void)state;
#if defined(__SSE__)
    enum { FLUSH_TO_ZERO = 0x8000, DENORMALS_ARE_ZERO = 0x0040 };
    static const unsigned bits[] = { FLUSH_TO_ZERO, DENORMALS_ARE_ZERO };
    const unsigned normal = _mm_getcsr();

    for (int i = 0; i < 2; i++) {
        _mm_setcsr(normal | bits[i]);
        const int ok = ted4_strict_ok();

        _mm_setcsr(normal);
        assert_false(ok);
    }
    assert_true(ted4_strict_ok());
#else
    print_message("skipped: the control word is known only of SSE\n");
    skip();
#endif
}

/* A process may have unmasked floating-point exceptions: what it does not compute must not trap. */
static void exceptions_do_not_end_the_process(void **state)
{
    (void)state;
#if defined(__SSE__)
    enum { INVALID_ZERO_OVERFLOW = 0x0080 | 0x0200 | 0x0400 /* masks of MXCSR */ };
    const unsigned normal = _mm_getcsr();

    _mm_setcsr(normal & ~(unsigned)INVALID_ZERO_OVERFLOW);
    const int ok = ted4_strict_ok();

    _mm_setcsr(normal);
    assert_true(ok);
#else
    print_message("skipped: the control word is known only of SSE\n");
    skip();
#endif
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pow2_is_within_two_tenths_of_a_millionth),
        cmocka_unit_test(pow2_of_whole_numbers_is_exact),
        cmocka_unit_test(pow2_is_clamped_and_keeps_nan),
        cmocka_unit_test(pow2_is_that_of_the_text),
        cmocka_unit_test(sigmoid_is_near_real_numbers),
        cmocka_unit_test(max_keeps_nan_of_its_second_argument),
        cmocka_unit_test(this_build_claims_class_x),
        cmocka_unit_test(other_rounding_is_noticed),
        cmocka_unit_test(flushing_is_noticed),
        cmocka_unit_test(exceptions_do_not_end_the_process),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
