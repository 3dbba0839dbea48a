/* buffer.c - see buffer.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "write/buffer.h"

#include <stdlib.h>

uint8_t *ted4_buffer_add(ted4_buffer *b, size_t size)
{
    uint8_t *p;

    if (b->failed || size > SIZE_MAX / 4 - b->size) {
        b->failed = 1;
        return NULL;
    }
    if (b->size + size > b->capacity) {
        const size_t capacity = 2 * b->size + size + 256;

        p = realloc(b->data, capacity);
        if (p == NULL) {
            b->failed = 1;
            return NULL;
        }
        b->data = p;
        b->capacity = capacity;
    }
    p = b->data + b->size;
    b->size += size;
    return p;
}

void ted4_buffer_free(ted4_buffer *b)
{
    free(b->data);
    b->data = NULL;
    b->size = b->capacity = 0;
}
