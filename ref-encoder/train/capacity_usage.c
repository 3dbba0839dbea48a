/* capacity_usage.c - what each Gaussian is worth to the pictures: see capacity.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "capacity.h"

#include <math.h>
#include <string.h>

enum { PICTURES = 32 };

/* Adds what one picture says. */
static void gather(const ted4_trainer *t, const ted4_splats *s, float weight, float *saving, float *size)
{
    const size_t K = t->layout.head.n_offsets;

    for (size_t i = 0; i < t->slots.n; i++)
        for (size_t k = 0; k < K; k++)
            for (size_t j = 0; j < TED4_LANES; j++) {
                const size_t at = (i * K + k) * TED4_LANES + j;
                const size_t anchor = t->slots.block[i] * (size_t)TED4_LANES + j;

                if (!(t->slots.lanes[i] >> j & 1))
                    continue;

                const float x = -weight * s->opacity[at] * t->splat_gradient.opacity[at];

                saving[anchor * K + k] += x;
                if (size != NULL)
                    size[anchor * K + k] += fabsf(x);
            }
}

int ted4_capacity_usage(ted4_trainer *t, float *saving, float *size)
{
    const size_t n = t->order.n < PICTURES ? t->order.n : PICTURES;
    const size_t all = t->anchors.n * t->layout.head.n_offsets;

    memset(saving, 0, all * sizeof *saving);
    if (size != NULL)
        memset(size, 0, all * sizeof *size);
    for (size_t i = 0; i < n; i++) {
        ted4_splats s;

        if (ted4_trainer_blame(t, ted4_capacity_picture(t, i, n), &s) != 0)
            return -1;
        gather(t, &s, 1.0f / (float)n, saving, size);
    }
    return 0;
}
