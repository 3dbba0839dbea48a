/* gaussian.c - spec 9.4: from a value to its slots, and back.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "norm/gaussian.h"

ted4_gauss_symbol ted4_gauss_of(int32_t mu, unsigned g, int32_t k)
{
    const int32_t  hw = ted4_half[g], m = ted4_floor_shift(mu, TED4_MU_BITS);
    const int32_t  fr = mu - m * (1 << TED4_MU_BITS), r = k - m;
    const uint32_t last = ted4_gauss_size(g) - 1;
    ted4_gauss_symbol s;
    uint32_t          j;

    if (r < -hw) {
        j = 0;
        s.escape = -hw - 1 - r;
    } else if (r > hw + 1) {
        j = last;
        s.escape = r - hw - 2;
    } else {
        j = (uint32_t)(r + hw + 1);
        s.escape = -1;
    }
    s.slots.start = ted4_gauss_cum(g, fr, j);
    s.slots.freq = ted4_gauss_cum(g, fr, j + 1) - s.slots.start;
    return s;
}

/* cum is strictly increasing, so bisection finds the only j with cum(j) <= slot < cum(j + 1). */
uint32_t ted4_gauss_find(unsigned g, int32_t fr, uint32_t slot,
                         ted4_slots *slots)
{
    uint32_t low = 0, high = ted4_gauss_size(g);
    uint32_t from = 0, to = 1u << TED4_SLOT_BITS;

    while (high - low > 1) {
        const uint32_t j = (low + high) / 2;
        const uint32_t c = ted4_gauss_inner(g, fr, j);

        if (c <= slot) {
            low = j;
            from = c;
        } else {
            high = j;
            to = c;
        }
    }
    slots->start = from;
    slots->freq = to - from;
    return low;
}
