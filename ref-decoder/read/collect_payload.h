/* collect_payload.h - the state of collect.c, and functions that find the errors of one payload.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_COLLECT_PAYLOAD_H
#define TED4_COLLECT_PAYLOAD_H

#include "read/decode.h"
#include "read/finding.h"

/* The maximum number of errors that are listed per chunk. */
enum { TED4_COLLECT_MOST = 100 };

typedef struct {
    ted4_findings *f;
    uint8_t *copy;  /* of the file; each error found is repaired in it, so that the bytes after
                       the error can be checked */
    uint8_t level;  /* the declared level; 31: it cannot be used */
    ted4_decoder d; /* reads the copy */
    int head, nete, posn; /* 1: the chunk has been read and is valid */
    int wrong;            /* 1: a payload had an error */
    int disordered;       /* 1: chunks were out of order, so their number is not checked */
    unsigned n_tile_chunks;
} ted4_collector;

/* Clears the error of the decoder and returns it. Reports it unless it is TED4_OK, or about the
 * order of chunks that have been reported as out of order. */
ted4_error ted4_collect_error(ted4_collector *c);

/* Each reports the errors of one payload of the copy. ted4_collect_head must be called first; the
 * others only if HEAD is valid. Only ted4_collect_tile may be called more than once. */
void ted4_collect_head(ted4_collector *c, const ted4_chunk_place *p);
void ted4_collect_nete(ted4_collector *c, const ted4_chunk_place *p);
void ted4_collect_blob(ted4_collector *c, const ted4_chunk_place *p, const char *element,
                       ted4_blob *b);
void ted4_collect_positions(ted4_collector *c, const ted4_chunk_place *p);
void ted4_collect_tile(ted4_collector *c, const ted4_chunk_place *p);

#endif
