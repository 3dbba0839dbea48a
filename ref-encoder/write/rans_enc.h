/* rans_enc.h - spec 9.2: the rANS encoder. It knows neither elements nor models. As rANS is last
 * in, first out, slots are collected and coded in reverse order when the substream ends. The
 * decoder is ref-decoder/read/rans_dec.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_RANS_ENC_H
#define TED4_RANS_ENC_H

#include "norm/gaussian.h"
#include "norm/rans.h"
#include "write/buffer.h"

typedef struct {
    uint16_t start, freq;
    uint8_t lane;
} ted4_rans_record;

/* An encoder that is all zero is valid. It is reused from substream to substream. */
typedef struct {
    ted4_rans_record *record; /* owned */
    size_t n, capacity;
    unsigned n_lanes, lane; /* lane: that of the next symbol */
    int failed;             /* nonzero: memory ran out */
} ted4_rans_enc;

void ted4_rans_enc_free(ted4_rans_enc *e);
/* Begins a substream of n > 0 symbols. */
void ted4_rans_enc_init(ted4_rans_enc *e, size_t n);
/* Adds slots for the current lane. Their freq is in 1 .. 65535. */
void ted4_rans_enc_put(ted4_rans_enc *e, ted4_slots s);
/* Advances to the lane of the next symbol. */
static inline void ted4_rans_enc_next(ted4_rans_enc *e)
{
    e->lane = (e->lane + 1) & (e->n_lanes - 1);
}
/* Ends the substream: appends the states of the lanes and the words to out. */
void ted4_rans_enc_finish(ted4_rans_enc *e, ted4_buffer *out);

#endif
