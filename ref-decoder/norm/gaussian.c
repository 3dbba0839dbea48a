/* gaussian.c - spec 9.4: maps a value to its slots, and a slot back to its symbol.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "norm/gaussian.h"

ted4_gauss_symbol ted4_gauss_of(int32_t mu, unsigned g, int32_t k)
{
    const int32_t hw = ted4_half[g], m = ted4_floor_shift(mu, TED4_MU_BITS);
    const int32_t fr = mu - m * (1 << TED4_MU_BITS), r = k - m;
    const uint32_t last = ted4_gauss_size(g) - 1;
    ted4_gauss_symbol s;
    uint32_t j;

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

/* Returns a symbol close to the one that contains slot: the inverse of the Gaussian distribution,
 * looked up in a table. d is in Q8 steps, as in spec 9.4; ted4_where is Q14, and
 * sigma = STEPI[128 + 2 (g mod 16)] 2^(g / 16 - 16). */
static uint32_t guess(unsigned g, int32_t fr, uint32_t slot)
{
    const int32_t d =
        ted4_floor_shift(ted4_where[slot / 256] * ted4_stepi[128 + 2 * (g % 16)], 22 - g / 16);

    return (uint32_t)ted4_clamp(ted4_floor_shift(d + 128 + fr, 8) + 1 + ted4_half[g], 0,
                                (int32_t)ted4_gauss_size(g) - 1);
}

/* cum is strictly increasing, so exactly one j has cum(j) <= slot < cum(j + 1). The guess is nearly
 * always right. Otherwise, steps of doubling length enclose j, and bisection finds it. */
uint32_t ted4_gauss_find(unsigned g, int32_t fr, uint32_t slot, ted4_slots *slots)
{
    const uint32_t size = ted4_gauss_size(g);
    uint32_t low = guess(g, fr, slot), high = low + 1;
    uint32_t from = ted4_gauss_cum(g, fr, low);
    uint32_t to = ted4_gauss_cum(g, fr, high);

    for (uint32_t step = 1; slot < from; step *= 2) {
        high = low;
        to = from;
        low = low > step ? low - step : 0;
        from = ted4_gauss_cum(g, fr, low);
    }
    for (uint32_t step = 1; slot >= to; step *= 2) {
        low = high;
        from = to;
        high = size - high > step ? high + step : size;
        to = ted4_gauss_cum(g, fr, high);
    }
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
