/* adam.h - the Adam optimiser step over rows of 32 lanes and over flat arrays. beta 0.9 and 0.999;
 * epsilon 1e-15, so that even the smallest gradients have an effect.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_ADAM_H
#define TED4_ADAM_H

#include <stddef.h>
#include <stdint.h>

#include "render/leveled.h"

#define TED4_ADAM_BETA1 0.9f
#define TED4_ADAM_BETA2 0.999f
#define TED4_ADAM_EPS   1e-15f

/* Bias corrections 1 / (1 - beta^step), for step >= 1. */
typedef struct {
    float m, v;
} ted4_adam_bias;

ted4_adam_bias ted4_adam_bias_make(uint64_t step);

/* x -= rate m' / (sqrt(v') + eps) for n values that share a learning rate. A gradient whose square
 * overflows binary32 moves nothing; v then stays at the largest finite number, from which it decays
 * again. */
TED4_EACH_LEVEL(void, ted4_adam, float *x, float *m, float *v, const float *gradient, size_t n,
                float rate, ted4_adam_bias bias);

/* Returns the learning rate on the geometric path from lr0 to lr0 last, at progress in [0, 1]. */
double ted4_decay(double lr0, double last, double progress);

#endif
