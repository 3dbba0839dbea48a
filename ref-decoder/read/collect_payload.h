/* collect_payload.h - the state of collect.c, and the errors of one payload.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_COLLECT_PAYLOAD_H
#define TED4_COLLECT_PAYLOAD_H

#include "read/decode.h"
#include "read/finding.h"

/* Errors of a chunk that are listed. */
enum { TED4_COLLECT_MOST = 100 };

typedef struct {
    ted4_findings *f;
    uint8_t *copy;  /* of the file; each error that has been found is repaired in it, so that what
                       follows can be judged */
    uint8_t level;  /* the declared level; 31: it cannot be used */
    ted4_decoder d; /* reads the copy */
    int head, nete, posn; /* 1: the chunk has been read and is right */
    int wrong;            /* 1: a payload had an error */
    int disordered;       /* 1: chunks were out of order, so their number is not judged */
    unsigned n_tile_chunks;
} ted4_collector;

/* Takes the first error out of the decoder, which forgets it, and reports it unless it is
 * TED4_OK. */
ted4_error ted4_collect_error(ted4_collector *c);

/* A payload of the copy: HEAD first, then the others of a file whose HEAD is right. Only TILE may
 * come more than once. */
void ted4_collect_head(ted4_collector *c, const ted4_chunk_place *p);
void ted4_collect_nete(ted4_collector *c, const ted4_chunk_place *p);
void ted4_collect_blob(ted4_collector *c, const ted4_chunk_place *p, const char *element,
                       ted4_blob *b);
void ted4_collect_positions(ted4_collector *c, const ted4_chunk_place *p);
void ted4_collect_tile(ted4_collector *c, const ted4_chunk_place *p);

#endif
