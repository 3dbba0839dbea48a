/* sine.h - spec 10.1, 11.3 (E(p), E(t)): the sine of the positional encodings, interpolated in a
 * table.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_SINE_H
#define TED4_SINE_H

#include "base/fixed.h"
#include "norm/tables.h"

/* Interpolates between a table entry and the next one, whose difference is rise. b is the fraction
 * of the way, in Q12. */
static inline int16_t ted4_sine_beyond(int16_t entry, int16_t rise, int16_t b)
{
    return (int16_t)(entry + ted4_round_shift(rise * b, 12));
}

/* Returns the sine of u in Q12, where 2^32 units of u are one turn. The cosine of u is the sine of
 * u + 2^30. */
static inline int16_t ted4_sine(uint32_t u)
{
    const uint32_t i = u >> 22;
    const int16_t b = (int16_t)(u >> 10 & 4095);

    return ted4_sine_beyond(ted4_sin[i], (int16_t)(ted4_sin[i + 1] - ted4_sin[i]), b);
}

#endif
