/* probe.c - tests whether this build, on this machine and in its present floating-point
 * environment, computes as class X requires (spec 12.2). Operands are volatile, so that the
 * compiler cannot compute the results in advance.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <float.h>
#include <math.h>
#include "recon/strict.h"
#include "ted4.h"

/* These functions are one expression each, which a compiler could contract or reorder. */
static float multiply_add(float a, float b, float c)
{
    return a * b + c;
}

static float there_and_back(float a, float b)
{
    return (a + b) - a;
}

/* (1 + 2^-12)^2 is rounded to 1 + 2^-11; a fused or wider operation keeps the term 2^-24. */
static int no_contraction(void)
{
    volatile float a = 1.0f + 0x1p-12f, b = a, c = -(1.0f + 0x1p-11f);
    volatile float r = multiply_add(a, b, c);

    return ted4_float_bits(r) == 0;
}

/* 2^24 + 1 is rounded to 2^24; excess precision or reordering keeps the 1. */
static int no_excess_or_reordering(void)
{
    volatile float a = 0x1p24f, b = 1.0f;
    volatile float r = there_and_back(a, b);

    return ted4_float_bits(r) == 0;
}

/* Computes the subnormal 2^-127 from 2^-126, and the reverse: subnormals must be supported as
 * results and as operands. */
static int no_flush(void)
{
    volatile float least = 0x1p-126f, half = 0.5f, two = 2.0f;
    volatile float small = least * half;
    volatile float back = small * two;

    return ted4_float_bits(small) == 0x00400000 && ted4_float_bits(back) == 0x00800000;
}

/* Tests ties to even, then rounding in both directions for both signs. */
static int rounds_to_nearest(void)
{
    static const struct {
        float a, b;
        uint32_t sum;
    } probe[] = {
        { 1.0f, 0x1p-24f, 0x3f800000 },           /* tie, down to even */
        { 0x1.000002p+0f, 0x1p-24f, 0x3f800002 }, /* tie, up to even */
        { 1.0f, 0x1.8p-24f, 0x3f800001 },         { 1.0f, 0x1p-25f, 0x3f800000 },
        { -1.0f, -0x1.8p-24f, 0xbf800001 },       { -1.0f, -0x1p-25f, 0xbf800000 },
    };
    int ok = 1;

    for (size_t i = 0; i < sizeof probe / sizeof probe[0]; i++) {
        volatile float a = probe[i].a, b = probe[i].b;
        volatile float r = a + b;

        ok &= ted4_float_bits(r) == probe[i].sum;
    }
    return ok;
}

/* A reciprocal approximation gives neither of these two results. */
static int divides_exactly(void)
{
    volatile float one = 1.0f, three = 3.0f, two = 2.0f;
    volatile float third = one / three, root = sqrtf(two);

    return ted4_float_bits(third) == 0x3eaaaaab && ted4_float_bits(root) == 0x3fb504f3;
}

/* A compiler that may replace a division by the multiplication with a reciprocal does so where
 * quotients share a divisor. Then 9 / 11 and 18 / 11 are off by one unit in the last place. */
static void divide_all(const volatile float *a, volatile float *q, float divisor)
{
    const float p0 = a[0] / divisor, p1 = a[1] / divisor, p2 = a[2] / divisor, p3 = a[3] / divisor;

    q[0] = p0;
    q[1] = p1;
    q[2] = p2;
    q[3] = p3;
}

static int no_reciprocal(void)
{
    volatile float a[4] = { 9.0f, 13.0f, 17.0f, 18.0f }, q[4], divisor = 11.0f;
    int ok = 1;

    divide_all(a, q, divisor);
    for (int i = 0; i < 4; i++) {
        volatile float alone = a[i] / divisor, constant = a[i] / 11.0f;

        ok &= ted4_float_bits(alone) == ted4_float_bits(q[i]) &&
              ted4_float_bits(alone) == ted4_float_bits(constant);
    }
    return ok;
}

static int differs_from_itself(float a)
{
    return a != a;
}

static float plus_zero(float a)
{
    return a + 0.0f;
}

/* Tests that NaN differs from itself, and that -0 + 0 is +0: the compiler must not assume
 * otherwise. */
static int no_assumptions(void)
{
    volatile float minus_zero = -0.0f;
    volatile float nan = ted4_bits_float(0x7fc00000u); /* no operation makes it: that may trap */
    volatile float sum = plus_zero(minus_zero);

    return differs_from_itself(nan) && ted4_float_bits(sum) == 0;
}

int ted4_strict_ok(void)
{
    return no_contraction() && no_excess_or_reordering() && no_flush() && rounds_to_nearest() &&
           divides_exactly() && no_reciprocal() && no_assumptions();
}

/* FLT_EVAL_METHOD is 16 on machines with binary16 arithmetic; they, too, compute binary32 as
 * binary32. */
int ted4_recon_class_x(void)
{
#if defined(__FAST_MATH__) || (FLT_EVAL_METHOD != 0 && FLT_EVAL_METHOD != 16)
    return 0;
#else
    return ted4_strict_ok();
#endif
}
