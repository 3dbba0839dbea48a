/* buffer.h - a byte string that grows.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_BUFFER_H
#define TED4_BUFFER_H

#include <stddef.h>
#include <stdint.h>

typedef struct {
    uint8_t *data; /* owned, malloc */
    size_t size, capacity;
    int failed; /* memory ran out: nothing more is added */
} ted4_buffer;

/* size bytes at the end, not initialised; NULL: no memory. All zero is an empty buffer. */
uint8_t *ted4_buffer_add(ted4_buffer *b, size_t size);
void ted4_buffer_free(ted4_buffer *b);

#endif
