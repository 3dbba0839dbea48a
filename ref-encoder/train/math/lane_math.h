/* lane_math.h - the functions of spec 11 and 12.2 in fast binary32, written so that `#pragma omp
 * simd` loops over lanes vectorise them. For files that are compiled once per level
 * (render/leveled.h).
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_LANE_MATH_H
#define TED4_LANE_MATH_H

#include <stdint.h>
#include <string.h>

#include "kernel/dense.h"
#include "recon/strict.h"
#include "render/leveled.h"

#define TED4_LN2 TED4_POW2_C1 /* the derivative of 2^x at 0 */

/* Clamps x to [low, high]; a NaN gives low. The result is safe to convert to an integer. */
static inline float ted4_lane_within(float x, float low, float high)
{
    x = x > low ? x : low;
    return x < high ? x : high;
}

/* Returns x if on is -1 and 0 if on is 0, even if x is NaN. It works on bits, which every
 * instruction set vectorises. */
static inline float ted4_lane_keep(int32_t on, float x)
{
    int32_t bits;
    float kept;

    memcpy(&bits, &x, sizeof bits);
    bits &= on;
    memcpy(&kept, &bits, sizeof kept);
    return kept;
}

/* Returns the integer nearest to x, |x| < 2^22, ties to even: adding the constant leaves no bits
 * for a fraction. SSE2 has no instruction for this. */
static inline float ted4_lane_round(float x)
{
    const float magic = 0x1.8p+23f;

    return (x + magic) - magic;
}

/* Returns 2^x with x clamped to [-126, 126], accurate to about 1e-7; a NaN gives NaN. x + 126.5 is
 * positive, so that truncation rounds x to the nearest integer. */
static inline float ted4_lane_pow2(float x)
{
    const float c = x < -126.0f ? -126.0f : x > 126.0f ? 126.0f : x;
    const int32_t n = (int32_t)(ted4_lane_within(x, -126.0f, 126.0f) + 126.5f);
    const float f = c - (float)(int32_t)((uint32_t)n - 126u);
    const uint32_t bits = ((uint32_t)n + 1u) << 23;
    float p = TED4_POW2_C7, scale;

    p = ted4_fma(p, f, TED4_POW2_C6);
    p = ted4_fma(p, f, TED4_POW2_C5);
    p = ted4_fma(p, f, TED4_POW2_C4);
    p = ted4_fma(p, f, TED4_POW2_C3);
    p = ted4_fma(p, f, TED4_POW2_C2);
    p = ted4_fma(p, f, TED4_POW2_C1);
    p = ted4_fma(p, f, 1.0f);
    memcpy(&scale, &bits, sizeof scale);
    return p * scale;
}

static inline float ted4_lane_sigmoid(float x)
{
    return 1.0f / (1.0f + ted4_lane_pow2(-x * TED4_LOG2E));
}

/* Adjoint of y = max(0, x), for n values. */
static inline void ted4_relu_backward(const float *y, size_t n, float *d)
{
#pragma omp simd
    for (size_t i = 0; i < n; i++)
        d[i] = y[i] > 0.0f ? d[i] : 0.0f;
}

/* Returns the gradient of a clamped x. Outside the range, only the part by which a descent step
 * moves x back inside is kept. */
static inline float ted4_inward(float x, float low, float high, float d)
{
    return (x <= low && d > 0.0f) || (x >= high && d < 0.0f) ? 0.0f : d;
}

/* Expands a lane mask to -1 and 0 per lane, for selection by bits: factors of 1.0 and 0.0 would let
 * NaN through. */
static inline void ted4_lane_set(uint32_t lanes, int32_t *on)
{
    for (int j = 0; j < TED4_LANES; j++)
        on[j] = -(int32_t)((lanes & (uint32_t)1 << j) != 0);
}

#endif
