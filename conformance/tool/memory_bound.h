/* memory_bound.h - spec 13.3: the most memory that decoding a file may take, and the most that a
 * query may take on top of that. The formulas use the header only, none of the decoder's own
 * derivations.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef CONF_MEMORY_BOUND_H
#define CONF_MEMORY_BOUND_H

#include <stdint.h>
#include "norm/syntax.h"

/* Returns R-LVL-005's bound on the bytes that decoding any file of file_bytes bytes may take, valid
 * or not: what the bytes of a file can pay for, at most. */
uint64_t conf_memory_paid(uint64_t file_bytes);
/* Returns M_E in bytes for a file of file_bytes bytes whose blobs have n_values values together, if
 * n_tiles > 0 tiles are decoded at the same time. */
uint64_t conf_memory_decode(const ted4_header *h, uint64_t file_bytes, uint64_t n_values,
                            uint64_t n_tiles);
/* Returns M_R in bytes, if a query gives n_records records. */
uint64_t conf_memory_query(const ted4_header *h, uint64_t n_values, uint64_t n_records);

#endif
