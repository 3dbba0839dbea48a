/* inflate.c - decompresses shuffled and deflated values with zlib (spec 7.2).
 * SPDX-License-Identifier: BSD-2-Clause */
#include "read/inflate.h"

#include <string.h>
#define ZLIB_CONST
#include <zlib.h>
#include "base/bytes.h"

/* The highest compression ratio of DEFLATE: two bits code at most 258 bytes. */
enum { MAX_RATIO = 1032 };

void *ted4_zlib_alloc(void *arena, unsigned n, unsigned size)
{
    return ted4_arena_alloc(arena, n, size);
}

void ted4_zlib_free(void *arena, void *block)
{
    ted4_arena_release(arena, block);
}

int ted4_inflate_impossible(size_t size, uint64_t n)
{
    return size >= 4 * n || 4 * n / MAX_RATIO >= size;
}

/* Inflates exactly out_size bytes, and returns a code of zlib. zlib counts in 32 bits, so the
 * output is produced in pieces. */
static int inflate_all(z_stream *z, uint8_t *out, size_t out_size)
{
    const size_t piece = (size_t)1 << 30;
    int verdict = Z_OK;

    while (verdict == Z_OK) {
        const size_t now = out_size < piece ? out_size : piece;

        z->next_out = out;
        z->avail_out = (unsigned)now;
        verdict = inflate(z, now == out_size ? Z_FINISH : Z_NO_FLUSH);
        out += now - z->avail_out;
        out_size -= now - z->avail_out;
        if (verdict == Z_OK && (z->avail_out > 0 || out_size == 0))
            return Z_DATA_ERROR;
    }
    return verdict == Z_STREAM_END && (out_size > 0 || z->avail_in > 0) ? Z_DATA_ERROR : verdict;
}

static void unshuffle(float *values, const uint8_t *bytes, size_t n)
{
    for (size_t i = 0; i < n; i++)
        values[i] = ted4_bits_float((uint32_t)bytes[i] | (uint32_t)bytes[n + i] << 8 |
                                    (uint32_t)bytes[2 * n + i] << 16 |
                                    (uint32_t)bytes[3 * n + i] << 24);
}

ted4_status ted4_inflate(ted4_arena *arena, const uint8_t *data, size_t size, float *values,
                         uint64_t n)
{
    uint8_t *bytes;
    z_stream z;
    int verdict;

    if (ted4_inflate_impossible(size, n))
        return TED4_E_NET_DEFLATE;
    bytes = ted4_arena_alloc(arena, n, 4);
    if (bytes == NULL)
        return TED4_E_LIMIT_MEMORY;
    memset(&z, 0, sizeof z);
    z.zalloc = ted4_zlib_alloc;
    z.zfree = ted4_zlib_free;
    z.opaque = arena;
    z.next_in = data;
    z.avail_in = (unsigned)size;
    verdict = inflateInit(&z);
    if (verdict == Z_OK) {
        verdict = inflate_all(&z, bytes, 4 * (size_t)n);
        (void)inflateEnd(&z);
    }
    if (verdict == Z_STREAM_END)
        unshuffle(values, bytes, (size_t)n);
    ted4_arena_release(arena, bytes);
    return verdict == Z_STREAM_END  ? TED4_OK
           : verdict == Z_MEM_ERROR ? TED4_E_LIMIT_MEMORY
                                    : TED4_E_NET_DEFLATE;
}
