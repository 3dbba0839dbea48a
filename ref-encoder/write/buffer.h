/* buffer.h - a byte string that grows.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_BUFFER_H
#define TED4_BUFFER_H

#include <stddef.h>
#include <stdint.h>

typedef struct {
    uint8_t *data; /* owned, malloc */
    size_t size, capacity;
    int failed; /* nonzero: memory ran out, and nothing more is added */
} ted4_buffer;

/* Appends size uninitialised bytes and returns a pointer to them, or NULL if there is no memory. A
 * buffer that is all zero is empty. */
uint8_t *ted4_buffer_add(ted4_buffer *b, size_t size);
void ted4_buffer_free(ted4_buffer *b);

#endif
