/* fix_hashes.c - see fix_hashes.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "fix_hashes.h"

#include <stdlib.h>
#include <string.h>
#include <xxhash.h>
#include "base/bytes.h"
#include "norm/coder.h"
#include "parse.h"
#include "write/encode.h"

size_t ted4_chunk_size(const uint8_t *data, size_t size, size_t at)
{
    uint64_t whole = TED4_FRAME_HEAD_SIZE + TED4_FRAME_HASH_SIZE;

    if (size < at || size - at < whole)
        return 0;
    whole += ted4_load32(data + at + 8);
    return size - at < whole ? 0 : (size_t)whole;
}

void ted4_fix_hashes(uint8_t *data, size_t size)
{
    for (size_t at = TED4_FILE_HEADER_SIZE, whole; at < size; at += whole) {
        whole = ted4_chunk_size(data, size, at);
        if (whole == 0)
            return;

        const size_t hashed = whole - TED4_FRAME_HASH_SIZE;

        ted4_store64(data + at + hashed, XXH3_64bits(data + at, hashed));
    }
}

void ted4_fix_rans_ends(uint8_t *data, size_t size)
{
    size_t ends;
    ted4_scene *const s = fuzz_parse(data, size, 0, &ends);

    if (s == NULL)
        return;
    if (ends + sizeof s->hash + TED4_FRAME_HASH_SIZE == size) {
        memcpy(data + ends, s->hash, sizeof s->hash);
        ted4_fix_hashes(data, size);
    }
    ted4_scene_free(s);
}

size_t ted4_fix_range_codes(uint8_t *data, size_t size, size_t max_size)
{
    size_t ends, n = 0;
    ted4_scene *const s = fuzz_parse(data, size, 1, &ends);
    uint8_t *out = NULL;

    if (s == NULL)
        return size;
    if (ted4_encode(s, s->level, NULL, &out, &n, NULL) != TED4_OK)
        (void)ted4_encode(s, 0, NULL, &out, &n, NULL);
    ted4_scene_free(s);
    if (out != NULL && n <= max_size) {
        memcpy(data, out, n);
        size = n;
    }
    free(out);
    return size;
}

size_t ted4_plain_file(uint8_t *to, const uint8_t *from, size_t size)
{
    size_t n = TED4_FILE_HEADER_SIZE;

    memcpy(to, from, n);
    to[9] = from[10] == TED4_PROFILE_MAIN ? 0 : 2;
    for (size_t at = n, whole; at < size; at += whole) {
        whole = ted4_chunk_size(from, size, at);
        if (!(ted4_load32(from + at + 4) & TED4_FLAG_CRITICAL))
            continue;
        memcpy(to + n, from + at, whole);
        n += whole;
    }
    return n;
}

size_t ted4_chunk_holding(const uint8_t *data, size_t size, size_t at)
{
    for (size_t i = TED4_FILE_HEADER_SIZE, whole; i < size && i <= at; i += whole) {
        whole = ted4_chunk_size(data, size, i);
        if (whole == 0)
            break;
        if (at < i + whole)
            return i;
    }
    return size;
}

size_t ted4_without_tail(const uint8_t *data, size_t size, size_t most)
{
    for (size_t i = TED4_FILE_HEADER_SIZE, whole; (whole = ted4_chunk_size(data, size, i)) > 0;
         i += whole)
        if (memcmp(data + i, ted4_chunk_type[TED4_ENDS], 4) == 0)
            return size - (i + whole) <= most ? i + whole : size;
    return size;
}
