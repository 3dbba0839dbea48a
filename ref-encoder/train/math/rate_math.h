/* rate_math.h - elementary functions of the rate model, written so that `#pragma omp simd` loops
 * over lanes vectorise them. For files that are compiled once per level (render/leveled.h). They
 * approximate the functions of spec 9.4.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_RATE_MATH_H
#define TED4_RATE_MATH_H

#include "base/bytes.h"
#include "lane_math.h"

/* Clamps x to [low, high]; a NaN stays NaN (unlike in ted4_lane_within, which is for integers). */
static inline float ted4_lane_limit(float x, float low, float high)
{
    x = x < low ? low : x;
    return x > high ? high : x;
}

/* Returns log2 of a normal x > 0: x = 2^n m with m in [sqrt(1/2), sqrt 2), then the series of the
 * inverse hyperbolic tangent of (m - 1) / (m + 1). */
static inline float ted4_lane_log2(float x)
{
    const uint32_t sqrt_half = 0x3f3504f3u;
    const uint32_t u = ted4_float_bits(x) - sqrt_half;
    const int32_t n = (int32_t)(u >> 23) - (int32_t)((u >> 31) << 9);
    const float m = ted4_bits_float((u & 0x7fffffu) + sqrt_half);
    const float z = (m - 1.0f) / (m + 1.0f), zz = z * z;
    float p = 0.320598898f; /* 2 / (k ln 2), k = 9, 7 .. 1 */

    p = ted4_fma(p, zz, 0.412198583f);
    p = ted4_fma(p, zz, 0.577078016f);
    p = ted4_fma(p, zz, 0.961796694f);
    p = ted4_fma(p, zz, 2.88539008f);
    return ted4_fma(z, p, (float)n);
}

/* Returns tanh x for |x| <= 0.3, by its series. */
static inline float ted4_lane_tanh_small(float x)
{
    const float xx = x * x;

    float p = 0.0218694885f;

    p = ted4_fma(p, xx, -0.0539682540f);
    p = ted4_fma(p, xx, 0.133333333f);
    p = ted4_fma(p, xx, -0.333333333f);
    p = ted4_fma(p, xx, 1.0f);
    return p * x;
}

/* Returns the density of the standard normal distribution. In the far tails, where the value no
 * longer matters, it stays at 2^-120, so that nothing becomes subnormal. */
static inline float ted4_lane_normal(float t)
{
    const float e = t * t * (-0.5f * TED4_LOG2E);

    return 0.398942280f * ted4_lane_pow2(e < -120.0f ? -120.0f : e);
}

/* Returns (1 - Phi(t)) / phi(t) for t >= 0, with a relative error of 1e-7, given y = 1 / (1 + t/4):
 * a polynomial fitted for the smallest relative error over t in [0, 196]. */
static inline float ted4_lane_mills(float y)
{
    float p = 0.0510913221f;

    p = ted4_fma(p, y, -0.209401367f);
    p = ted4_fma(p, y, 0.252017418f);
    p = ted4_fma(p, y, -0.0920271200f);
    p = ted4_fma(p, y, 0.167158245f);
    p = ted4_fma(p, y, 0.145130673f);
    p = ted4_fma(p, y, 0.205119998f);
    p = ted4_fma(p, y, 0.234219276f);
    p = ted4_fma(p, y, 0.250005753f);
    p = ted4_fma(p, y, 0.249999928f);
    return p * y;
}

#endif
