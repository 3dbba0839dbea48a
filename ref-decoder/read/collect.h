/* collect.h - the state of collect.c and its part collect_payload.c.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_COLLECT_H
#define TED4_COLLECT_H

#include "read/decode.h"
#include "read/finding.h"

/* Errors of a chunk that are listed. */
enum { TED4_COLLECT_MOST = 100 };

typedef struct {
    ted4_findings *f;
    uint8_t *copy; /* of the file: what has been found is mended in it, so that what lies behind can
                      be judged */
    uint8_t level; /* declared; 31: it cannot be used */
    ted4_decoder d;       /* reads the copy */
    int head, nete, posn; /* 1: read, and right */
    int wrong;            /* something in a payload was */
    int disordered;       /* chunks were out of order: how many there are is not judged */
    unsigned n_tile_chunks;
} ted4_collector;

/* The first error of the decoder, which forgets it. Given to the sink unless it is TED4_OK. */
ted4_error ted4_collect_error(ted4_collector *c);

/* A payload of the copy; HEAD, then the others of a file whose HEAD is right. No chunk comes twice
 * but TILE. */
void ted4_collect_head(ted4_collector *c, const ted4_chunk_place *p);
void ted4_collect_nete(ted4_collector *c, const ted4_chunk_place *p);
void ted4_collect_blob(ted4_collector *c, const ted4_chunk_place *p, const char *element,
                       ted4_blob *b);
void ted4_collect_positions(ted4_collector *c, const ted4_chunk_place *p);
void ted4_collect_tile(ted4_collector *c, const ted4_chunk_place *p);

#endif
