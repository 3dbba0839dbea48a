/* adam_step.c - the step of adam.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "adam.h"

#include <float.h>
#include <math.h>

void TED4_LEVELED(ted4_adam)(float *restrict x, float *restrict m, float *restrict v,
                             const float *restrict gradient, size_t n, float rate,
                             ted4_adam_bias bias)
{
    const float step = rate * bias.m;

#pragma omp simd
    for (size_t i = 0; i < n; i++) {
        const float g = gradient[i];
        const float a = TED4_ADAM_BETA1 * m[i] + (1.0f - TED4_ADAM_BETA1) * g;
        const float b = TED4_ADAM_BETA2 * v[i] + (1.0f - TED4_ADAM_BETA2) * g * g;

        m[i] = a;
        v[i] = b > FLT_MAX ? FLT_MAX : b;
        x[i] -= step * a / (sqrtf(b * bias.v) + TED4_ADAM_EPS);
    }
}
