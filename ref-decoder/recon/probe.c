/* probe.c - spec 12.2: does this build, on this machine, with this floating-point environment, compute as class X asks?
 * Operands are volatile, so that the compiler cannot answer for the machine.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <float.h>
#include "recon/strict.h"
#include "ted4.h"

/* One expression each, as a compiler would contract or reorder it. */
static float multiply_add(float a, float b, float c)
{
    return a * b + c;
}

static float there_and_back(float a, float b)
{
    return (a + b) - a;
}

/* (1 + 2^-12)^2 is 1 + 2^-11 after rounding; a fused or wider operation keeps the 2^-24. */
static int no_contraction(void)
{
    volatile float a = 1.0f + 0x1p-12f, b = a, c = -(1.0f + 0x1p-11f);
    volatile float r = multiply_add(a, b, c);

    return ted4_float_bits(r) == 0;
}

/* 2^24 + 1 is 2^24. */
static int no_excess_or_reordering(void)
{
    volatile float a = 0x1p24f, b = 1.0f;
    volatile float r = there_and_back(a, b);

    return ted4_float_bits(r) == 0;
}

/* 2^-127 from 2^-126, and back; both sides must know subnormals. */
static int no_flush(void)
{
    volatile float least = 0x1p-126f, half = 0.5f, two = 2.0f;
    volatile float small = least * half;
    volatile float back = small * two;

    return ted4_float_bits(small) == 0x00400000 && ted4_float_bits(back) == 0x00800000;
}

/* Ties to even, then both directions, for both signs. */
static int rounds_to_nearest(void)
{
    static const struct { float a, b; uint32_t sum; } probe[] = {
        { 1.0f, 0x1p-24f, 0x3f800000 },         /* tie, down to even */
        { 0x1.000002p+0f, 0x1p-24f, 0x3f800002 }, /* tie, up to even */
        { 1.0f, 0x1.8p-24f, 0x3f800001 },
        { 1.0f, 0x1p-25f, 0x3f800000 },
        { -1.0f, -0x1.8p-24f, 0xbf800001 },
        { -1.0f, -0x1p-25f, 0xbf800000 },
    };
    int ok = 1;

    for (size_t i = 0; i < sizeof probe / sizeof probe[0]; i++) {
        volatile float a = probe[i].a, b = probe[i].b;
        volatile float r = a + b;

        ok &= ted4_float_bits(r) == probe[i].sum;
    }
    return ok;
}

/* Neither is what a reciprocal approximation gives. */
static int divides_exactly(void)
{
    volatile float one = 1.0f, three = 3.0f, two = 2.0f;
    volatile float third = one / three, root = sqrtf(two);

    return ted4_float_bits(third) == 0x3eaaaaab && ted4_float_bits(root) == 0x3fb504f3;
}

int ted4_strict_ok(void)
{
    return no_contraction() && no_excess_or_reordering() && no_flush() &&
           rounds_to_nearest() && divides_exactly();
}

int ted4_recon_class_x(void)
{
#if defined(__FAST_MATH__) || FLT_EVAL_METHOD != 0
    return 0;
#else
    return ted4_strict_ok();
#endif
}
