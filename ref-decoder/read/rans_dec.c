/* rans_dec.c - spec 9.2: begins and ends the decoding of a substream.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "read/rans_dec.h"

ted4_status ted4_rans_dec_init(ted4_rans_dec *d, const uint8_t *data, size_t size, size_t n)
{
    const size_t n_lanes = ted4_rans_lanes(n);

    if (size < 4 * n_lanes || size % 2 != 0)
        return TED4_E_ENT_SIZE;
    d->n_lanes = (unsigned)n_lanes;
    d->lane = 0;
    d->underrun = 0;
    d->word = data + 4 * n_lanes;
    d->end = data + size;
    for (size_t i = 0; i < n_lanes; i++) {
        d->state[i] = ted4_load32(data + 4 * i);
        if (d->state[i] < TED4_RANS_LOW)
            return TED4_E_ENT_STATE;
    }
    return TED4_OK;
}

ted4_status ted4_rans_dec_finish(const ted4_rans_dec *d)
{
    for (unsigned i = 0; i < d->n_lanes; i++)
        if (d->state[i] != TED4_RANS_LOW)
            return TED4_E_ENT_FINAL;
    return d->word == d->end ? TED4_OK : TED4_E_ENT_FINAL;
}
