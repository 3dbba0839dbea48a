/* deflate.c - see deflate.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "write/deflate.h"

#include <zlib.h>
#include "base/bytes.h"

/* Stores byte 0 of all values, then byte 1 of all values, and so on. */
static void shuffle(uint8_t *bytes, const float *values, size_t n)
{
    for (size_t i = 0; i < n; i++) {
        const uint32_t u = ted4_float_bits(values[i]);

        for (unsigned j = 0; j < 4; j++)
            bytes[j * n + i] = (uint8_t)(u >> 8 * j);
    }
}

size_t ted4_deflate_bound(size_t n)
{
    return compressBound((uLong)(4 * n));
}

int ted4_deflate(const float *values, size_t n, uint8_t *work, uint8_t *packed, size_t *size)
{
    uLongf length = compressBound((uLong)(4 * n));
    const int best = 9;

    shuffle(work, values, n);
    if (compress2(packed, &length, work, (uLong)(4 * n), best) != Z_OK || length >= 4 * n)
        return 0;
    *size = length;
    return 1;
}
