/* mutator.c - libFuzzer's mutations, made where they are of use: mostly inside the payload of one chunk, whose size is kept right, and
 * with mended hashes.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <stdlib.h>
#include <string.h>
#include "base/bytes.h"
#include "mend.h"
#include "norm/coder.h"

size_t LLVMFuzzerMutate(uint8_t *data, size_t size, size_t max_size);
size_t LLVMFuzzerCustomMutator(uint8_t *data, size_t size, size_t max_size, unsigned seed);

/* Mutates the payload of the chunk at an offset. Gives the new size of the file. */
static size_t mutate_payload(uint8_t *data, size_t size, size_t max_size, size_t at)
{
    const size_t begin = at + TED4_FRAME_HEAD_SIZE, old = ted4_load32(data + at + 8);
    const size_t tail = size - begin - old, room = old + (max_size - size);
    uint8_t     *const payload = malloc(room > 0 ? room : 1);
    size_t       n;

    if (payload == NULL)
        return size;
    memcpy(payload, data + begin, old);
    n = LLVMFuzzerMutate(payload, old, room);
    memmove(data + begin + n, data + begin + old, tail);
    memcpy(data + begin, payload, n);
    ted4_store32(data + at + 8, (uint32_t)n);
    free(payload);
    return begin + n + tail;
}

size_t LLVMFuzzerCustomMutator(uint8_t *data, size_t size, size_t max_size, unsigned seed)
{
    const unsigned how = seed % 8;
    const size_t   at = size > 0 ? ted4_chunk_holding(data, size, seed / 8 % size) : size;

    if (how > 1 && at < size)
        size = mutate_payload(data, size, max_size, at);
    else
        size = LLVMFuzzerMutate(data, size, max_size);
    if (how > 0)
        ted4_mend_chunks(data, size);
    if (how > 3)
        ted4_mend_ends(data, size);
    return size;
}
