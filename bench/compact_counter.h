/* compact_counter.h - a coder that counts the bits of binary symbols.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_COMPACT_COUNTER_H
#define TED4_COMPACT_COUNTER_H

#include <math.h>
#include "norm/coder.h"

typedef struct {
    ted4_coder base; /* must be first */
    double bits;
} compact_counter;

static inline int compact_count_bit(ted4_coder *c, uint32_t prob, int value)
{
    ((compact_counter *)c)->bits -= log2((value ? prob : 65536 - prob) / 65536.0);
    return value;
}

static const ted4_coder_ops compact_counter_ops = { .bit = compact_count_bit };

#endif
