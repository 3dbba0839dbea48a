/* stream.h - a file taken apart, to be broken and put together again with right sizes and hashes
 * (all but what a recipe wants wrong).
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef CONF_STREAM_H
#define CONF_STREAM_H

#include "build.h"

enum { CONF_CHUNKS = 64 };

typedef struct {
    uint8_t type[4];
    uint32_t flags;
    conf_bytes payload; /* owned */
    int64_t size;       /* what the frame says; -1: the payload's size */
    int bad_hash;
} conf_chunk;

/* A syntax element of the valid file. chunk: number, -1 for the file header; at: offset in its
 * payload, or in the file header. */
typedef struct {
    char name[24];
    int64_t index;
    int chunk;
    size_t at;
} conf_element;

typedef struct {
    const conf_build *build; /* borrowed */
    uint8_t header[12];
    conf_chunk chunk[CONF_CHUNKS];
    int n;
    conf_bytes tail;       /* behind the last chunk */
    int64_t cut;           /* bytes to keep; -1: all */
    conf_element *element; /* owned; of the file as it was */
    size_t n_elements;
    int moved[CONF_CHUNKS]; /* where chunk i of the valid file is now; -1: gone */
} conf_stream;

/* Of a valid file and the scene in it, which is borrowed. */
void conf_stream_open(conf_stream *s, const conf_bytes *file, const conf_build *b);
void conf_stream_close(conf_stream *s);
/* The bytes of the file as it is now. */
void conf_stream_join(const conf_stream *s, conf_bytes *file);

/* "TILE1": the second TILE that is there now; ends the program when there is none. */
int conf_stream_chunk(const conf_stream *s, const conf_line *l, const char *ref);
/* "bank_rows", "step[2]", "NETR.mode", "TILE1.size[3]": the first one of the valid file. */
const conf_element *conf_stream_element(const conf_stream *s, const conf_line *l, const char *ref);
/* Where chunk number i begins now. */
size_t conf_stream_place(const conf_stream *s, int i);
/* Substream number sub of a TILE chunk: offset in its payload now, and size; *size_at: where its
 * size stands. */
size_t conf_stream_substream(const conf_stream *s, int chunk, unsigned sub, size_t *size,
                             size_t *size_at);

/* breaks.c: a `do` line. b: the scene of the file. */
void conf_stream_do(conf_stream *s, conf_build *b, const conf_line *l);
/* An offset in the file as it is now, from word i on: a number; size or size-N; ELEMENT [N]; chunk
 * REF [N]; payload REF [N]; last REF N (from the payload's end); stream TILE SUB [N]; bias NET
 * LAYER UNIT. */
size_t conf_stream_where(const conf_stream *s, const conf_line *l, int i);

#endif
