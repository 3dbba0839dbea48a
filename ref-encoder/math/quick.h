/* quick.h - 2^x and the logistic function in binary32, to about 1e-7 and 2e-7, for loops that
 * run over every anchor in every step: written so that `#pragma omp simd` vectorises them, and
 * of plain operations, so that they have the same bits in whatever file, on whatever machine
 * (elementary.h says why that counts).
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_QUICK_H
#define TED4_QUICK_H

#include <stdint.h>
#include <string.h>

/* x clamped to [-126, 126]; -126 for a NaN. c + 126.5 is positive, so that truncation rounds c
 * to the nearest integer; a polynomial fitted to 2^f on [-1/2, 1/2] makes the rest. */
static inline float ted4_quick_exp2(float x)
{
    const float    low = x > -126.0f ? x : -126.0f, c = low < 126.0f ? low : 126.0f;
    const int32_t  n = (int32_t)(c + 126.5f);
    const float    f = c - (float)(n - 126);
    const uint32_t bits = (uint32_t)(n + 1) << 23;
    float          p = 0x1.ffcbfcp-17f, scale;

    p = p * f + 0x1.430912p-13f;
    p = p * f + 0x1.5d87fep-10f;
    p = p * f + 0x1.3b2ab6p-7f;
    p = p * f + 0x1.c6b08ep-5f;
    p = p * f + 0x1.ebfbep-3f;
    p = p * f + 0x1.62e43p-1f;
    p = p * f + 1.0f;
    memcpy(&scale, &bits, sizeof scale);
    return p * scale;
}

static inline float ted4_quick_logistic(float x)
{
    return 1.0f / (1.0f + ted4_quick_exp2(-x * 0x1.715476p+0f));
}

#endif
