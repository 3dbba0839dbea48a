/* container.h - the container format (spec 5): pass 1 over a file, as a whole or chunk by chunk,
 * and stepping from chunk to chunk in pass 2.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_CONTAINER_H
#define TED4_CONTAINER_H

#include "read/reader.h"

/* Runs pass 1 of spec 5.3: checks the file header, and the frames, hashes and order of chunks.
 * r must read the whole file from its first byte; r->base.error holds the verdict. */
void ted4_container_check(ted4_reader *r);

/* A chunk of a file that passed pass 1. */
typedef struct {
    size_t at;           /* offset of its type */
    size_t payload, end; /* offsets */
    int type;            /* ted4_chunk; TED4_CHUNKS: an ancillary chunk */
} ted4_chunk_place;

/* A part of pass 1: checks the file header, and the file size against the bounds of the level.
 * Returns the level, and the profile in *profile. */
uint8_t ted4_container_header(ted4_reader *r, uint8_t *profile);
/* A part of pass 1: checks the frame, hash and order of the chunk at r's position, moves the
 * position behind the chunk, and returns the chunk. *before is the type of the last known chunk
 * (-1: none yet) and is updated. If r has failed before, or if the chunk does not fit in the file,
 * returns an ancillary chunk with all offsets 0 and leaves *before unchanged. */
ted4_chunk_place ted4_container_judge(ted4_reader *r, int *before);

/* Returns the chunk at r's position, and moves the position behind it. */
ted4_chunk_place ted4_container_next(ted4_reader *r);

#endif
