/* elementary.c - see elementary.h. Steps that are exact, or nearly exact, reduce the argument to a
 * range in which a power series converges quickly.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "elementary.h"

#include <math.h>

/* ln 2 and pi / 2 are split into parts. All but the last parts have so few bits that their products
 * with the integers n below are exact. */
#define LN2_HIGH     0x1.62e42feep-1
#define LN2_LOW      0x1.a39ef35793c76p-33
#define QUARTER_HIGH 0x1.921fb544p+0
#define QUARTER_MID  0x1.0b4611a6p-34
#define QUARTER_LOW  0x1.3198a2e037073p-69

#define LN2        0x1.62e42fefa39efp-1
#define LOG2_E     0x1.71547652b82fep+0
#define TWO_PER_PI 0x1.45f306dc9c883p-1
#define SQRT_HALF  0x1.6a09e667f3bcdp-1
#define MOST_SIN   1e5

/* Returns e^r for |r| <= 0.35, by its series. The first omitted term is below 5e-18. */
static double exp_series(double r)
{
    double p = 1.0 / 6227020800;

    p = p * r + 1.0 / 479001600;
    p = p * r + 1.0 / 39916800;
    p = p * r + 1.0 / 3628800;
    p = p * r + 1.0 / 362880;
    p = p * r + 1.0 / 40320;
    p = p * r + 1.0 / 5040;
    p = p * r + 1.0 / 720;
    p = p * r + 1.0 / 120;
    p = p * r + 1.0 / 24;
    p = p * r + 1.0 / 6;
    p = p * r + 0.5;
    return 1.0 + (r + r * r * p);
}

double ted4_math_exp(double x)
{
    if (!(fabs(x) < 750.0))
        return x > 0 ? (double)INFINITY : x < 0 ? 0.0 : x;

    const double n = rint(x * LOG2_E);

    return ldexp(exp_series((x - n * LN2_HIGH) - n * LN2_LOW), (int)n);
}

double ted4_math_exp2(double x)
{
    if (!(fabs(x) < 1100.0))
        return x > 0 ? (double)INFINITY : x < 0 ? 0.0 : x;

    const double n = rint(x);

    return ldexp(exp_series((x - n) * LN2), (int)n);
}

/* Returns ln(1 + f) for 1 + f in [sqrt(1/2), sqrt(2)). With s = f / (2 + f), this equals
 *     2 artanh(s) = f - f^2 / 2 + s (f^2 / 2 + R),  R = 2 s^2 / 3 + 2 s^4 / 5 + ...,
 * whose first term is exact. The first omitted term is below 1e-18 of the result. */
static double log_series(double f)
{
    const double s = f / (2.0 + f), z = s * s, half = 0.5 * f * f;
    double p = 2.0 / 23;

    p = p * z + 2.0 / 21;
    p = p * z + 2.0 / 19;
    p = p * z + 2.0 / 17;
    p = p * z + 2.0 / 15;
    p = p * z + 2.0 / 13;
    p = p * z + 2.0 / 11;
    p = p * z + 2.0 / 9;
    p = p * z + 2.0 / 7;
    p = p * z + 2.0 / 5;
    p = p * z + 2.0 / 3;
    return f - (half - s * (half + z * p));
}

/* Splits x into 2^e (1 + f) with 1 + f in [sqrt(1/2), sqrt(2)) and returns 1. For 0, infinity, NaN
 * and negative numbers it returns 0, and *f is the logarithm itself. */
static int split(double x, double *f, int *e)
{
    if (!(x > 0) || isinf(x)) {
        *f = x == 0 ? -(double)INFINITY : x < 0 ? (double)NAN : x;
        return 0;
    }
    *f = frexp(x, e);
    if (*f < SQRT_HALF) {
        *f *= 2.0;
        *e -= 1;
    }
    *f -= 1.0;
    return 1;
}

double ted4_math_log(double x)
{
    double f;
    int e;

    return split(x, &f, &e) ? e * LN2_HIGH + (log_series(f) + e * LN2_LOW) : f;
}

double ted4_math_log2(double x)
{
    double f;
    int e;

    return split(x, &f, &e) ? e + log_series(f) * LOG2_E : f;
}

double ted4_math_pow(double x, double y)
{
    if (y == 0 || x == 1.0)
        return 1.0;
    return ted4_math_exp2(y * ted4_math_log2(x));
}

/* Return sin(r) and cos(r) for |r| <= 0.79, by their series. */
static double sin_series(double r)
{
    const double z = r * r;
    double p = -1.0 / 121645100408832000;

    p = p * z + 1.0 / 355687428096000;
    p = p * z - 1.0 / 1307674368000;
    p = p * z + 1.0 / 6227020800;
    p = p * z - 1.0 / 39916800;
    p = p * z + 1.0 / 362880;
    p = p * z - 1.0 / 5040;
    p = p * z + 1.0 / 120;
    p = p * z - 1.0 / 6;
    return r + r * z * p;
}

static double cos_series(double r)
{
    const double z = r * r;
    double p = 1.0 / 2432902008176640000;

    p = p * z - 1.0 / 6402373705728000;
    p = p * z + 1.0 / 20922789888000;
    p = p * z - 1.0 / 87178291200;
    p = p * z + 1.0 / 479001600;
    p = p * z - 1.0 / 3628800;
    p = p * z + 1.0 / 40320;
    p = p * z - 1.0 / 720;
    p = p * z + 1.0 / 24;
    return 1.0 - (0.5 * z - z * z * p);
}

/* Returns r of x = n pi / 2 + r with the nearest integer n; *quarter is n mod 4, from 0 to 3.
 * |x| <= MOST_SIN. */
static double reduce(double x, int *quarter)
{
    const double n = rint(x * TWO_PER_PI);

    *quarter = (int)n & 3;
    return ((x - n * QUARTER_HIGH) - n * QUARTER_MID) - n * QUARTER_LOW;
}

double ted4_math_sin(double x)
{
    int quarter;

    if (!(fabs(x) <= MOST_SIN))
        return (double)NAN;

    const double r = reduce(x, &quarter);
    const double y = quarter & 1 ? cos_series(r) : sin_series(r);

    return quarter & 2 ? -y : y;
}

double ted4_math_tan(double x)
{
    int quarter;

    if (!(fabs(x) <= MOST_SIN))
        return (double)NAN;

    const double r = reduce(x, &quarter);

    return quarter & 1 ? -cos_series(r) / sin_series(r) : sin_series(r) / cos_series(r);
}
