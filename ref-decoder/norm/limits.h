/* limits.h - spec 13: the levels, and the quantities that levels and the limits of a decoder bound.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_LIMITS_H
#define TED4_LIMITS_H

#include <stdint.h>
#include "norm/syntax.h"

enum { TED4_LEVEL_UNBOUNDED = 31 };

/* The largest values that a level allows. */
typedef struct {
    uint8_t level;
    uint32_t n_anchors, n_offsets, frames;
    uint64_t values;   /* f32 values in all blobs */
    uint64_t products; /* multiplications per anchor in Tier E */
    uint64_t file_bytes;
    uint64_t symbols_per_byte;
} ted4_limits;

/* Returns the bounds of a level, or NULL if there is no such level. */
const ted4_limits *ted4_limits_of(unsigned level);

/* spec 13: returns N (F + 6 + 3K + d + 4) symbols without the terms of absent types, as if all
 * anchors moved and all offsets were kept. */
uint64_t ted4_count_symbols(const ted4_header *h, const ted4_shape *s);
/* Returns the sum of inputs x outputs over the layers of Tier E, which is per anchor. */
uint64_t ted4_count_products(const ted4_header *h, const ted4_shape *s);
/* Returns W_E of spec 13.4, which depends on HEAD and on the size of the file in bytes. */
uint64_t ted4_count_work(const ted4_header *h, const ted4_shape *s, uint64_t file_bytes);
/* spec 13.4: returns the steps of a query, N A_R + 20 G, where n_records is G, the number of kept
 * offsets of the scene. */
uint64_t ted4_count_query_work(const ted4_header *h, const ted4_shape *s, uint64_t n_records);

/* Returns 1 if a file of file_bytes bytes respects those bounds of the level that involve several
 * elements, else 0. */
int ted4_limits_hold(const ted4_limits *l, const ted4_header *h, const ted4_shape *s,
                     uint64_t file_bytes);

/* R-ENC-002: returns the lowest level all of whose bounds hold for a file of file_bytes bytes. */
unsigned ted4_level_lowest(const ted4_header *h, const ted4_shape *s, uint64_t file_bytes);

#endif
