/* inflate.c - spec 7.2 without zlib: read/inflate.h by the decoder that annex L prints, which the
 * build takes out of the text.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "read/inflate.h"

#include <string.h>
#include "base/bytes.h"
#include "spec/inflate.h"

/* DEFLATE codes at most 258 bytes in two bits. */
enum { MAX_RATIO = 1032 };

int ted4_inflate_impossible(size_t size, uint64_t n)
{
    return size >= 4 * n || 4 * n / MAX_RATIO >= size;
}

ted4_status ted4_inflate(ted4_arena *arena, const uint8_t *data, size_t size, float *values,
                         uint64_t n)
{
    uint8_t *bytes;
    int valid;

    if (ted4_inflate_impossible(size, n))
        return TED4_E_NET_DEFLATE;
    bytes = ted4_arena_alloc(arena, n, 4);
    if (bytes == NULL)
        return TED4_E_LIMIT_MEMORY;
    valid = inflate_exactly(data, size, bytes, 4 * (size_t)n);
    for (size_t i = 0; valid && i < n; i++)
        values[i] = ted4_bits_float((uint32_t)bytes[i] | (uint32_t)bytes[n + i] << 8 |
                                    (uint32_t)bytes[2 * n + i] << 16 |
                                    (uint32_t)bytes[3 * n + i] << 24);
    ted4_arena_release(arena, bytes);
    return valid ? TED4_OK : TED4_E_NET_DEFLATE;
}
