/* lane_sum.h - sums of many binary32 products in a fixed order that depends neither on the compiler
 * nor on the width of vectors: term i is added to partial sum i mod 16, and the upper half of the
 * partial sums is then repeatedly added to the lower half. Only plain operations are used, for the
 * reason that elementary.h gives.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_LANE_SUM_H
#define TED4_LANE_SUM_H

#include <stddef.h>

enum { TED4_SUM_LANES = 16 };

/* Returns the sum of the 16 partial sums, which it overwrites. */
static inline float ted4_lanes_total(float *part)
{
    for (int half = TED4_SUM_LANES / 2; half > 0; half /= 2)
        for (int j = 0; j < half; j++)
            part[j] += part[j + half];
    return part[0];
}

/* Returns the dot product of x[n] and y[n]. */
static inline float ted4_lane_dot(size_t n, const float *x, const float *y)
{
    float part[TED4_SUM_LANES] = { 0 };
    size_t i = 0;

    for (; i + TED4_SUM_LANES <= n; i += TED4_SUM_LANES)
#pragma omp simd
        for (size_t j = 0; j < TED4_SUM_LANES; j++)
            part[j] += x[i + j] * y[i + j];
    for (size_t j = 0; i + j < n; j++)
        part[j] += x[i + j] * y[i + j];
    return ted4_lanes_total(part);
}

#endif
