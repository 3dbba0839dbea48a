/* chunks.h - the chunks of a file that a decoder accepted, one after the other (spec 5.2).
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_TOOL_CHUNKS_H
#define TED4_TOOL_CHUNKS_H

#include <stddef.h>
#include <stdint.h>

/* Sizes in bytes: the file header (5.1), and what precedes and follows a payload. */
enum { TED4_FILE_HEADER = 12, TED4_CHUNK_HEAD = 12, TED4_CHUNK_HASH = 8 };
enum { TED4_CHUNK_IS_CRITICAL = 1, TED4_CHUNK_IS_SAFE = 2 }; /* bits of flags */

typedef struct {
    size_t at, end; /* offsets of the whole chunk in the file */
    char type[5];   /* with a terminating 0 */
    uint32_t flags;
    const uint8_t *payload; /* borrowed from the file */
    size_t size;            /* of the payload */
} ted4_chunk_view;

/* Reads the chunk at *at, which is TED4_FILE_HEADER for the first one, and moves *at behind it.
 * Returns 1, or 0 at the end of the file; also if the file ends within a chunk, so that a file that
 * no decoder accepted is read without harm. */
int ted4_chunks_next(const uint8_t *file, size_t size, size_t *at, ted4_chunk_view *c);

#endif
