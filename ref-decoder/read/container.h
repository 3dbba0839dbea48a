/* container.h - spec 5: pass 1 over a file, at once or chunk by chunk, and stepping from chunk to
 * chunk in pass 2.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_CONTAINER_H
#define TED4_CONTAINER_H

#include "read/reader.h"

/* spec 5.3, pass 1: file header, frames, hashes, order. r reads the whole file from its first byte.
 */
void ted4_container_check(ted4_reader *r);

/* A chunk of a file that passed pass 1. */
typedef struct {
    size_t at;           /* offset of its type */
    size_t payload, end; /* offsets */
    int type;            /* ted4_chunk, or TED4_CHUNKS: an ancillary one */
} ted4_chunk_place;

/* Parts of pass 1. File header, and file size against its level, which is given. */
uint8_t ted4_container_header(ted4_reader *r);
/* The chunk at r's position, which moves behind it; frame, hash and order are judged. *before: type
 * of the last known chunk, -1: none yet; moves on. Nothing at all when r has failed before, or the
 * chunk does not fit in the file. */
ted4_chunk_place ted4_container_judge(ted4_reader *r, int *before);

/* The chunk at r's position, which moves behind it. */
ted4_chunk_place ted4_container_next(ted4_reader *r);

#endif
