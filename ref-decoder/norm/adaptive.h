/* adaptive.h - the probability of a binary symbol, learned from the symbols coded so far, in
 * integers. Both ends of the coder update it alike, so that nothing about it is stored.
 * No count can overflow: seen stays within 0 .. TED4_ADAPTIVE_MEMORY, and p within
 * TED4_ADAPTIVE_LEAST .. 2^16 - TED4_ADAPTIVE_LEAST, as an update clamps both. Its product is below
 * 2^16 x 2^16 / 3 < 2^31.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_ADAPTIVE_H
#define TED4_ADAPTIVE_H

#include <stddef.h>
#include "base/fixed.h"

enum { TED4_ADAPTIVE_MEMORY = 24, TED4_ADAPTIVE_LEAST = 32 };

/* p: the probability of 1, in units of 2^-16. seen: symbols so far, up to TED4_ADAPTIVE_MEMORY. */
typedef struct {
    uint16_t p;
    uint8_t seen;
} ted4_adaptive;

/* Sets m[n] to the state before the first symbol, in which both values are equally likely. */
static inline void ted4_adaptive_init(ted4_adaptive *m, size_t n)
{
    for (size_t i = 0; i < n; i++)
        m[i] = (ted4_adaptive) { 32768, 0 };
}

/* Moves p towards value (0 or 1) by the part 1 / (seen + 3/2) of the distance: close to a mean over
 * all symbols at first, and then over the last ones. */
static inline void ted4_adaptive_update(ted4_adaptive *m, int value)
{
    const int32_t part = 65536 / (2 * m->seen + 3);
    const int32_t step = ted4_floor_shift(((value ? 65535 : 0) - m->p) * part, 15);

    m->p = (uint16_t)ted4_clamp(m->p + step, TED4_ADAPTIVE_LEAST, 65536 - TED4_ADAPTIVE_LEAST);
    if (m->seen < TED4_ADAPTIVE_MEMORY)
        m->seen++;
}

#endif
