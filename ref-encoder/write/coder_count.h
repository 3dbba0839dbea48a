/* coder_count.h - the coder that counts bits: it adds up -log2 of the coded frequencies
 * (norm/coder.h).
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_CODER_COUNT_H
#define TED4_CODER_COUNT_H

#include "norm/coder.h"

enum { TED4_COUNTER_SUBSTREAMS = 24 };

typedef struct {
    ted4_coder base; /* must be first */
    double frame;    /* bits that are not coded as slots */
    double substream[TED4_COUNTER_SUBSTREAMS];
    unsigned n_opened;
} ted4_counter;

void ted4_counter_init(ted4_counter *n);

#endif
