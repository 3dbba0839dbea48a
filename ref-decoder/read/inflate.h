/* inflate.h - decompresses values that are shuffled and deflated (spec 7.2).
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_INFLATE_H
#define TED4_INFLATE_H

#include "base/arena.h"

/* data must be exactly one zlib stream (RFC 1950) of size bytes that holds n < 2^62 shuffled
 * binary32 values. Returns TED4_OK with values[n] filled, TED4_E_NET_DEFLATE, or
 * TED4_E_LIMIT_MEMORY. */
ted4_status ted4_inflate(ted4_arena *arena, const uint8_t *data, size_t size, float *values,
                         uint64_t n);
/* Returns 1 if a stream of that size cannot hold n values, or is not smaller than they are. In that
 * case ted4_inflate does not access its values, which may be NULL. */
int ted4_inflate_impossible(size_t size, uint64_t n);
/* zalloc and zfree of a z_stream whose opaque is a ted4_arena. */
void *ted4_zlib_alloc(void *arena, unsigned n, unsigned size);
void ted4_zlib_free(void *arena, void *block);

#endif
