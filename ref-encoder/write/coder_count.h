/* coder_count.h - the coder that adds up -log2 of frequencies (norm/coder.h).
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_CODER_COUNT_H
#define TED4_CODER_COUNT_H

#include "norm/coder.h"

enum { TED4_COUNTER_SUBSTREAMS = 24 };

typedef struct {
    ted4_coder base; /* must be first */
    double frame;    /* bits outside the slots */
    double substream[TED4_COUNTER_SUBSTREAMS];
    unsigned n_opened;
} ted4_counter;

void ted4_counter_init(ted4_counter *n);

#endif
