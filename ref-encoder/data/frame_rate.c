/* frame_rate.c - see frame_rate.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "data/frame_rate.h"

#include <math.h>

static const double THOUSAND = 1000;

/* Gives the last convergent p/q of the rate's continued fraction that is within the bounds. p0/q0
 * is the convergent before it. */
static void expand(double rate, uint32_t *num, uint32_t *den)
{
    uint64_t p0 = 0, q0 = 1, p = 1, q = 0;

    for (double x = rate; floor(x) <= TED4_RATE_MOST; x = 1 / (x - floor(x))) {
        const uint64_t a = (uint64_t)x, p1 = a * p + p0, q1 = a * q + q0;

        if (p1 > TED4_RATE_MOST || q1 > TED4_RATE_MOST)
            break;
        p0 = p;
        q0 = q;
        p = p1;
        q = q1;
        if (x == floor(x) || (double)p / (double)q == rate)
            break;
    }
    *num = (uint32_t)p;
    *den = (uint32_t)q;
}

int ted4_frame_rate(double rate, uint32_t *num, uint32_t *den)
{
    const double thousandths = rint(THOUSAND * rate);

    if (!(rate >= 1.0 / TED4_RATE_MOST && rate <= TED4_RATE_MOST))
        return -1;
    if (thousandths <= TED4_RATE_MOST && thousandths / THOUSAND == rate) {
        *num = (uint32_t)thousandths;
        *den = (uint32_t)THOUSAND;
    } else {
        expand(rate, num, den);
    }
    return 0;
}
