/* sine.h - spec 10.1, 11.3 (E(p), E(t)): the sine of the positional encodings, from its table.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_SINE_H
#define TED4_SINE_H

#include "base/fixed.h"
#include "norm/tables.h"

/* Q12; u in turns of 2^32. The cosine is the sine of u + 2^30. */
static inline int16_t ted4_sine(uint32_t u)
{
    const uint32_t i = u >> 22;
    const int32_t  b = (int32_t)(u >> 10 & 4095);

    return (int16_t)(ted4_sin[i] + ted4_round_shift((ted4_sin[i + 1] - ted4_sin[i]) * b, 12));
}

#endif
