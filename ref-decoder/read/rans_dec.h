/* rans_dec.h - the rANS decoder (spec 9.2). It knows neither syntax elements nor the entropy model.
 * Its counterpart is ref-encoder/write/rans_enc.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_RANS_DEC_H
#define TED4_RANS_DEC_H

#include "base/bytes.h"
#include "base/status.h"
#include "norm/gaussian.h"
#include "norm/rans.h"

typedef struct {
    const uint8_t *word, *end; /* borrowed: the words that are not read yet */
    unsigned n_lanes, lane;    /* lane: that of the next symbol */
    int underrun;              /* a word was missing */
    uint32_t state[TED4_MAX_LANES];
} ted4_rans_dec;

/* Begins a substream of n > 0 symbols. Returns TED4_OK, TED4_E_ENT_SIZE or TED4_E_ENT_STATE. */
ted4_status ted4_rans_dec_init(ted4_rans_dec *d, const uint8_t *data, size_t size, size_t n);
/* Checks the end of the substream (R-ENT-005). Returns TED4_OK or TED4_E_ENT_FINAL. */
ted4_status ted4_rans_dec_finish(const ted4_rans_dec *d);

/* Returns the slot of the next symbol of the current lane. */
static inline uint32_t ted4_rans_dec_slot(const ted4_rans_dec *d)
{
    return d->state[d->lane] & 0xffff;
}

/* Consumes the symbol whose slots are s; they must contain the current slot. */
static inline void ted4_rans_dec_take(ted4_rans_dec *d, ted4_slots s)
{
    uint32_t x = d->state[d->lane];

    x = s.freq * (x >> TED4_SLOT_BITS) + (x & 0xffff) - s.start;
    if (x < TED4_RANS_LOW) {
        if (d->word == d->end) {
            d->underrun = 1;
            x = TED4_RANS_LOW;
        } else {
            x = x << 16 | ted4_load16(d->word);
            d->word += 2;
        }
    }
    d->state[d->lane] = x;
}

/* Moves on to the lane of the next symbol. */
static inline void ted4_rans_dec_next(ted4_rans_dec *d)
{
    d->lane = (d->lane + 1) & (d->n_lanes - 1);
}

#endif
