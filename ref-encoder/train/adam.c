/* adam.c - see adam.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "adam.h"

#include <float.h>
#include <math.h>

#include "math/elementary.h"

ted4_adam_bias ted4_adam_bias_make(uint64_t step)
{
    const double n = (double)step;

    return (ted4_adam_bias){
        (float)(1.0 / (1.0 - ted4_math_pow((double)TED4_ADAM_BETA1, n))),
        (float)(1.0 / (1.0 - ted4_math_pow((double)TED4_ADAM_BETA2, n)))
    };
}

void ted4_adam(float *restrict x, float *restrict m, float *restrict v,
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

double ted4_decay(double lr0, double last, double progress)
{
    const double p = progress < 0 ? 0 : progress > 1 ? 1 : progress;

    return lr0 * ted4_math_pow(last, p);
}
