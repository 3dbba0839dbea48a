/* mend.c - see mend.h. The decoder gives nothing of a file that it refuses, so its source is part of this one, under another name.
 * SPDX-License-Identifier: BSD-2-Clause */
#define ted4_decode ted4_mend_decode
#include "read/decode.c"

#include <xxhash.h>
#include "base/bytes.h"
#include "harness.h"
#include "mend.h"

/* Bytes of the chunk at an offset, its hash included; 0: it does not fit. */
static size_t chunk_size(const uint8_t *data, size_t size, size_t at)
{
    uint64_t whole = TED4_FRAME_HEAD_SIZE + TED4_FRAME_HASH_SIZE;

    if (size - at < whole)
        return 0;
    whole += ted4_load32(data + at + 8);
    return size - at < whole ? 0 : (size_t)whole;
}

void ted4_mend_chunks(uint8_t *data, size_t size)
{
    for (size_t at = TED4_FILE_HEADER_SIZE, whole; at < size; at += whole) {
        whole = chunk_size(data, size, at);
        if (whole == 0)
            return;

        const size_t hashed = whole - TED4_FRAME_HASH_SIZE;

        ted4_store64(data + at + hashed, XXH3_64bits(data + at, hashed));
    }
}

void ted4_mend_ends(uint8_t *data, size_t size)
{
    static const ted4_options o = { .max_bytes = FUZZ_MAX_BYTES };
    decoder                   d;

    memset(&d, 0, sizeof d);
    d.o = &o;
    ted4_reader_init(&d.file, data, 0, size, 1);
    ted4_container_check(&d.file);
    if (d.file.base.error.code != TED4_OK || (d.s = ted4_scene_empty(&o)) == NULL)
        return;
    read_payloads(&d);
    if (d.file.base.error.code == TED4_E_SYN_HASH) {
        memcpy(data + d.file.base.error.offset, d.s->hash, sizeof d.s->hash);
        ted4_mend_chunks(data, size);
    }
    ted4_scene_free(d.s);
}

size_t ted4_plain_file(uint8_t *to, const uint8_t *from, size_t size)
{
    size_t n = TED4_FILE_HEADER_SIZE;

    memcpy(to, from, n);
    to[9] = 0;
    for (size_t at = n, whole; at < size; at += whole) {
        whole = chunk_size(from, size, at);
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
        whole = chunk_size(data, size, i);
        if (whole == 0)
            break;
        if (at < i + whole)
            return i;
    }
    return size;
}
