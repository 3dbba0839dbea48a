/* capacity_usage.c - what each Gaussian is worth to the pictures: see capacity.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "capacity.h"

#include <math.h>
#include <string.h>

enum { PICTURES = 32 };

/* Forward and most of the way back. */
#define STEPS_A_PICTURE (2.0 / 3.0)

static size_t pictures(const ted4_trainer *t)
{
    return t->order.n < PICTURES ? t->order.n : PICTURES;
}

double ted4_capacity_usage_steps(const ted4_trainer *t)
{
    return STEPS_A_PICTURE * (double)pictures(t);
}

/* Adds what one picture says. */
static void gather(const ted4_trainer *t, const ted4_splats *s, float weight, float *use)
{
    const size_t K = t->layout.head.n_offsets;

    for (size_t i = 0; i < t->slots.n; i++)
        for (size_t k = 0; k < K; k++)
            for (size_t j = 0; j < TED4_LANES; j++) {
                const size_t at = (i * K + k) * TED4_LANES + j;
                const size_t anchor = t->slots.block[i] * (size_t)TED4_LANES + j;

                if (!(t->slots.lanes[i] >> j & 1))
                    continue;

                use[anchor * K + k] += weight * fabsf(s->opacity[at] * t->splat_gradient.opacity[at]);
            }
}

int ted4_capacity_usage(ted4_trainer *t, float *use)
{
    const size_t n = pictures(t);

    memset(use, 0, t->anchors.n * t->layout.head.n_offsets * sizeof *use);
    for (size_t i = 0; i < n; i++) {
        ted4_splats s;

        if (ted4_trainer_blame(t, ted4_capacity_picture(t, i, n), &s) != 0)
            return -1;
        gather(t, &s, 1.0f / (float)n, use);
    }
    return 0;
}
