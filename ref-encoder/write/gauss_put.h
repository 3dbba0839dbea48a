/* gauss_put.h - spec 9.4, the encoder's side: turns a symbol k into a sequence of slots. Shared by
 * coder_write.c and coder_count.c.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_GAUSS_PUT_H
#define TED4_GAUSS_PUT_H

#include "base/status.h"
#include "norm/gaussian.h"
#include "norm/rans.h"

/* Calls put(user, slots) for the symbol and for each bit of its escape. Returns TED4_OK,
 * TED4_E_ENT_SYMBOL_RANGE or TED4_E_ENT_ESCAPE. */
static inline ted4_status ted4_gauss_put(int32_t mu, unsigned g, int32_t k,
                                         void (*put)(void *user, ted4_slots s), void *user)
{
    const ted4_slots zero = { 0, TED4_RANS_LOW / 2 };
    const ted4_slots one = { TED4_RANS_LOW / 2, TED4_RANS_LOW / 2 };
    const ted4_gauss_symbol s = ted4_gauss_of(mu, g, k);
    uint32_t value;
    unsigned n;

    if (k < -32767 || k > 32767)
        return TED4_E_ENT_SYMBOL_RANGE;
    put(user, s.slots);
    if (s.escape < 0)
        return TED4_OK;
    value = (uint32_t)s.escape + 1;
    n = ted4_log2_floor(value);
    if (n > TED4_ESCAPE_BITS)
        return TED4_E_ENT_ESCAPE;
    for (unsigned i = 0; i < n; i++)
        put(user, one);
    put(user, zero);
    for (unsigned i = n; i > 0; i--)
        put(user, value >> (i - 1) & 1 ? one : zero);
    return TED4_OK;
}

#endif
