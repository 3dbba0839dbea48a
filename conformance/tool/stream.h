/* stream.h - splits a file into parts, so that it can be broken and joined again. Sizes and hashes
 * are computed anew, except those that a recipe wants to be wrong.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef CONF_STREAM_H
#define CONF_STREAM_H

#include "build.h"

enum { CONF_CHUNKS = 64 };

typedef struct {
    uint8_t type[4];
    uint32_t flags;
    conf_bytes payload; /* owned */
    int64_t size;       /* the size that the frame declares; -1: that of the payload */
    int bad_hash;
} conf_chunk;

/* A syntax element of the valid file. chunk: index, or -1 for the file header; at: offset in the
 * payload of the chunk, or in the file header. */
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
    conf_bytes tail;       /* after the last chunk */
    int64_t cut;           /* number of bytes to keep; -1: all */
    conf_element *element; /* owned; elements of the valid file */
    size_t n_elements;
    int moved[CONF_CHUNKS]; /* current index of chunk i of the valid file; -1: removed */
} conf_stream;

/* Splits a valid file. b, with the scene of the file, is borrowed. */
void conf_stream_open(conf_stream *s, const conf_bytes *file, const conf_build *b);
void conf_stream_close(conf_stream *s);
/* Joins the parts into the bytes of the file in its current state. */
void conf_stream_join(const conf_stream *s, conf_bytes *file);

/* Returns the index of the chunk that ref names: "TILE1" is the second TILE that currently exists.
 * Ends the program if there is none. */
int conf_stream_chunk(const conf_stream *s, const conf_line *l, const char *ref);
/* Returns the first element of that name in the valid file: "bank_rows", "step[2]", "NETR.mode",
 * "TILE1.size[3]". */
const conf_element *conf_stream_element(const conf_stream *s, const conf_line *l, const char *ref);
/* Returns the current offset of chunk i. */
size_t conf_stream_place(const conf_stream *s, int i);
/* Returns the current offset of substream sub in the payload of a TILE chunk. Sets *size to its
 * size and *size_at to the offset of its size field. */
size_t conf_stream_substream(const conf_stream *s, int chunk, unsigned sub, size_t *size,
                             size_t *size_at);

/* breaks.c: executes a `do` line. b: the scene of the file. */
void conf_stream_do(conf_stream *s, conf_build *b, const conf_line *l);
/* Parses an offset in the file in its current state, from word i on: a number; size or size-N;
 * ELEMENT [N]; chunk REF [N]; payload REF [N]; last REF N (from the end of the payload); stream
 * TILE SUB [N]; bias NET LAYER UNIT. */
size_t conf_stream_where(const conf_stream *s, const conf_line *l, int i);

#endif
