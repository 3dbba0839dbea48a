/* elementary.h - our own exp, log, pow, sin and tan, for results that affect training or a file:
 * those of libm differ between its versions and between machines. The functions consist of +, -, *,
 * / and exact steps (rounding to an integer, scaling by a power of two) in binary64, without
 * contraction, so that their results have the same bits wherever binary64 is IEEE 754's. Values
 * that are only reported (PSNR in a log, eval/metrics.h) may use libm. The relative error is at
 * most 4e-16 unless stated otherwise below; tests/encoder/test_elementary.c verifies this. Results
 * beyond the range of binary64 are infinite or 0, and the functions of NaN are NaN.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_ELEMENTARY_H
#define TED4_ELEMENTARY_H

double ted4_math_exp(double x);
double ted4_math_exp2(double x); /* exact for integers */

/* The result is NaN for negative numbers and -infinity for 0. */
double ted4_math_log(double x);
double ted4_math_log2(double x); /* exact for powers of two */

/* Returns x^y for x >= 0, NaN for other x, and 1 for y = 0. The relative error is at most
 * 3e-16 (2 + |y log2(x)|). */
double ted4_math_pow(double x, double y);

/* For |x| <= 10^5; the result is NaN otherwise. The relative error of the tangent is at most
 * 6e-16. */
double ted4_math_sin(double x);
double ted4_math_tan(double x);

/* The same functions rounded to binary32. */
static inline float ted4_math_expf(float x)
{
    return (float)ted4_math_exp((double)x);
}

static inline float ted4_math_exp2f(float x)
{
    return (float)ted4_math_exp2((double)x);
}

static inline float ted4_math_log2f(float x)
{
    return (float)ted4_math_log2((double)x);
}

static inline float ted4_math_sinf(float x)
{
    return (float)ted4_math_sin((double)x);
}

#endif
