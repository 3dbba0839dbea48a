/* inflate.h - spec 7.2: shuffled and deflated values.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_INFLATE_H
#define TED4_INFLATE_H

#include "base/arena.h"

/* Exactly one RFC 1950 stream of size bytes that holds n shuffled binary32. TED4_OK,
 * TED4_E_NET_DEFLATE, or TED4_E_LIMIT_MEMORY. n: below 2^62. */
ted4_status ted4_inflate(ted4_arena *arena, const uint8_t *data, size_t size, float *values,
                         uint64_t n);
/* No stream of that size can hold n values: then values need not exist yet. */
int ted4_inflate_impossible(size_t size, uint64_t n);
/* zalloc and zfree of a z_stream whose opaque is a ted4_arena. */
void *ted4_zlib_alloc(void *arena, unsigned n, unsigned size);
void ted4_zlib_free(void *arena, void *block);

#endif
