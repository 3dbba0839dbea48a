/* rans.h - spec 9.2: the constants and the number of lanes that the rANS encoder and decoder share.
 * The arithmetic is in read/rans_dec.c and ref-encoder/write/rans_enc.c.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_RANS_H
#define TED4_RANS_H

#include <stddef.h>
#include <stdint.h>

enum { TED4_MAX_LANES = 64, TED4_SYMBOLS_PER_LANE = 4096 };

#define TED4_RANS_LOW \
    ((uint32_t)1      \
     << 16) /* least legal state; the state before the first and after the last symbol */

/* Returns the number of lanes of a substream of n > 0 symbols: the largest power of two that is at
 * most n / 4096, limited to 1 .. 64. */
static inline unsigned ted4_rans_lanes(size_t n)
{
    unsigned lanes = 1;

    while (lanes < TED4_MAX_LANES && 2 * lanes <= n / TED4_SYMBOLS_PER_LANE)
        lanes *= 2;
    return lanes;
}

#endif
