/* chunks.c - see chunks.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "chunks.h"

#include <string.h>

#include "base/bytes.h"

int ted4_chunks_next(const uint8_t *file, size_t size, size_t *at, ted4_chunk_view *c)
{
    const size_t frame = TED4_CHUNK_HEAD + TED4_CHUNK_HASH;

    if (*at > size || size - *at < frame)
        return 0;
    memset(c, 0, sizeof *c);
    c->at = *at;
    memcpy(c->type, file + *at, 4);
    c->flags = ted4_load32(file + *at + 4);
    c->size = ted4_load32(file + *at + 8);
    c->payload = file + *at + TED4_CHUNK_HEAD;
    if (c->size > size - *at - frame)
        return 0;
    *at += frame + c->size;
    c->end = *at;
    return 1;
}
