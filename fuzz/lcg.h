/* lcg.h - the small random generator of harnesses whose seeds and regressions depend on its
 * sequence.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_FUZZ_LCG_H
#define TED4_FUZZ_LCG_H

#include <stdint.h>

static inline uint32_t lcg_next(uint32_t *state)
{
    return *state = *state * 1664525 + 1013904223;
}

#endif
