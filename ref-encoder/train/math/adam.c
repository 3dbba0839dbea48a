/* adam.c - bias correction and decay of the learning rate, and the call of the step in the version
 * for the instruction set in use (adam.h).
 * SPDX-License-Identifier: BSD-2-Clause */
#include "adam.h"

#include "math/elementary.h"

ted4_adam_bias ted4_adam_bias_make(uint64_t step)
{
    const double n = (double)step;

    return (ted4_adam_bias) { (float)(1.0 / (1.0 - ted4_math_pow((double)TED4_ADAM_BETA1, n))),
                              (float)(1.0 / (1.0 - ted4_math_pow((double)TED4_ADAM_BETA2, n))) };
}

void ted4_adam(float *x, float *m, float *v, const float *gradient, size_t n, float rate,
               ted4_adam_bias bias)
{
    TED4_IN_USE(ted4_adam)(x, m, v, gradient, n, rate, bias);
}

double ted4_decay(double lr0, double last, double progress)
{
    const double p = progress < 0 ? 0 : progress > 1 ? 1 : progress;

    return lr0 * ted4_math_pow(last, p);
}
