/* elementary.h - exp, log, pow, sin and tan of our own, for results that enter a training or a
 * file: those of libm differ between its versions and machines. Made of +, -, *, / and exact
 * steps (rounding to an integer, scaling by a power of two) in binary64, without contraction, so
 * that they have the same bits wherever binary64 is IEEE 754's. What is only reported (PSNR in a
 * log, eval/metrics.h) may use libm. Relative error, as tests/encoder/test_elementary.c bounds it:
 * 4e-16, or as said below; results beyond binary64's range are infinite or 0, those of NaN are
 * NaN.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_ELEMENTARY_H
#define TED4_ELEMENTARY_H

double ted4_math_exp(double x);
double ted4_math_exp2(double x); /* exact for integers */

/* NaN of negative numbers, -infinity of 0. */
double ted4_math_log(double x);
double ted4_math_log2(double x); /* exact for powers of two */

/* x^y for x >= 0, NaN for other x; 1 for y = 0. Relative error 3e-16 (2 + |y log2(x)|). */
double ted4_math_pow(double x, double y);

/* |x| <= 10^5, else NaN. Relative error of the tangent 6e-16. */
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
