/* record.h - spec 11.6: converts a record from a structure of arrays to bytes.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_RECORD_H
#define TED4_RECORD_H

#include <stddef.h>
#include "base/bytes.h"

enum { TED4_RECORD_FLOATS = 14 };

/* The columns of g in record order; g is any structure with the members mean, scale, rot, opacity
 * and colour. */
#define TED4_RECORD_COLUMNS(g)                                                                 \
    {                                                                                          \
        (g)->mean[0], (g)->mean[1], (g)->mean[2], (g)->scale[0], (g)->scale[1], (g)->scale[2], \
            (g)->rot[0], (g)->rot[1], (g)->rot[2], (g)->rot[3], (g)->opacity, (g)->colour[0],  \
            (g)->colour[1], (g)->colour[2]                                                     \
    }

static inline void ted4_record_store(uint8_t bytes[4 * TED4_RECORD_FLOATS],
                                     const float *const column[TED4_RECORD_FLOATS], size_t i)
{
    for (int k = 0; k < TED4_RECORD_FLOATS; k++)
        ted4_store32(bytes + 4 * k, ted4_float_bits(column[k][i]));
}

#endif
