/* chunk_exchange.h - sums over chunks of a step's work, of which each process has some neighbouring
 * ones: chunk by chunk as by one process, so the bits are the same. Depends on exchange.h,
 * view_sums.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_CHUNK_EXCHANGE_H
#define TED4_CHUNK_EXCHANGE_H

#include "exchange.h"
#include "view_sums.h"

/* Returns the first of n chunks that belongs to a rank. */
size_t ted4_chunk_first(const ted4_exchange *x, size_t rank, size_t n);
/* Adds the arrays [size] of n chunks in their order to to[size] of all processes, if add is 0 to
 * nothing. chunk: [n], of which this process fills its own; to may be one of them. Each process
 * adds a part of the arrays. s: for memory. Returns 0, or -1 if memory ran out. */
int ted4_chunk_exchange(ted4_exchange *x, ted4_view_sums *s, const float *const *chunk, size_t n,
                        size_t size, int add, float *to);

#endif
