/* coder.h - style: one walk per syntax structure, and a coder that says what a walk does: read,
 * write or count. The walks (walk_*.c) know elements, order, contexts and limits; coders know bytes
 * and slots. Any coder can be traced. Coders: read/reader.c, ref-encoder/write/coder_write.c and
 * coder_count.c.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_CODER_H
#define TED4_CODER_H

#include "norm/syntax.h"

typedef struct ted4_coder ted4_coder;

/* Each operation gets the value to be coded and gives the value coded: a reading coder ignores what
 * it gets, the others give it back. After a failure operations do nothing, and numbers are 0. */
typedef struct {
    /* An unsigned number of 1, 2 or 4 bytes. */
    uint32_t (*number)(ted4_coder *c, unsigned width, uint32_t value);
    /* n numbers of width bytes, an array in memory. One that does not fit is not touched: n may be
     * a file's claim that no size_t holds, and values NULL. */
    void (*array)(ted4_coder *c, unsigned width, void *values, uint64_t n);
    /* spec 7.2, mode 1: the opaque bytes up to the end of the chunk. A reader also inflates them
     * into b->values. */
    void (*deflated)(ted4_coder *c, ted4_blob *b);
    /* spec 9.1: size[n]; a writer fills them in later, by close. */
    void (*sizes)(ted4_coder *c, uint32_t *size, unsigned n);
    /* spec 9.2: the next substream, of n symbols, and its end. */
    void (*open)(ted4_coder *c, size_t n);
    void (*close)(ted4_coder *c);
    /* spec 9.3: one binary symbol, 1 in slots [0, prob). */
    int (*bit)(ted4_coder *c, uint32_t prob, int value);
    /* spec 9.4: n symbols k, with their mu and sigma index. */
    void (*gauss)(ted4_coder *c, size_t n, const int32_t *mu, const uint8_t *sigma, int16_t *k);
} ted4_coder_ops;

struct ted4_coder {
    const ted4_coder_ops *ops;
    int reads;        /* 1: values come out of the coder; 0: they go in */
    size_t pos;       /* offset in the file of the next byte */
    ted4_error error; /* the first failure */
    void (*trace)(void *user, size_t offset, const char *element, int64_t index,
                  int64_t value); /* NULL: off */
    void *trace_user;
};

/* Fails at offset at unless the condition holds. Gives the condition. */
static inline int ted4_require(ted4_coder *c, int holds, ted4_status code, size_t at)
{
    if (!holds)
        ted4_fail(&c->error, code, at);
    return holds;
}

static inline void ted4_trace(ted4_coder *c, size_t at, const char *element, int64_t index,
                              int64_t value)
{
    if (c->trace != NULL && c->error.code == TED4_OK)
        c->trace(c->trace_user, at, element, index, value);
}

/* index: of an array element, 0 for a single one. */
static inline uint32_t ted4_code(ted4_coder *c, const char *element, int64_t index, unsigned width,
                                 uint32_t value)
{
    const size_t at = c->pos;

    value = c->ops->number(c, width, value);
    ted4_trace(c, at, element, index, value);
    return value;
}

/* walk_container.c - spec 5. A frame is what stands around a chunk's payload. */
typedef struct {
    uint8_t type[4];
    uint32_t flags, size;
} ted4_frame;

enum {
    TED4_FILE_HEADER_SIZE = 12,
    TED4_FRAME_HEAD_SIZE = 12,
    TED4_FRAME_HASH_SIZE = 8,
    TED4_FLAG_CRITICAL = 1,
    TED4_FLAG_COPY = 2
};

/* The chunks of R-CON-003. */
typedef enum {
    TED4_HEAD,
    TED4_NETE,
    TED4_NETR,
    TED4_BANK,
    TED4_POSN,
    TED4_TILE,
    TED4_ENDS,
    TED4_CHUNKS
} ted4_chunk;

extern const char ted4_chunk_type[TED4_CHUNKS][5];

/* Magic, versions, profile, level. */
void ted4_walk_file_header(ted4_coder *c, uint8_t *level);
/* Type, flags and size. */
void ted4_walk_frame(ted4_coder *c, ted4_frame *f);
/* spec 15.2: payload of ENDS. hash: what it has to be. */
void ted4_walk_ends(ted4_coder *c, const uint8_t *hash);

/* walk_header.c - spec 6.1. Fills *shape. file_bytes: for the bounds of spec 13; UINT64_MAX: not
 * known yet, not judged. */
void ted4_walk_header(ted4_coder *c, ted4_header *h, ted4_shape *shape, unsigned level,
                      uint64_t file_bytes);

/* walk_nets.c - spec 7. values of the blobs are allocated; a reader leaves those untouched that
 * cannot be read. */
struct ted4_prior;
void ted4_walk_nete(ted4_coder *c, ted4_scene *s, struct ted4_prior *prior);
void ted4_walk_blob(ted4_coder *c, const char *element, ted4_blob *b);

/* walk_positions.c - spec 8. */
void ted4_walk_positions(ted4_coder *c, ted4_scene *s);

/* walk_tile.c - spec 9, 10. work: ted4_tile_work_size() bytes, aligned to 64, contents do not
 * matter. */
size_t ted4_tile_work_size(const ted4_scene *s); /* SIZE_MAX: too large for this machine */
void ted4_walk_tile(ted4_coder *c, ted4_scene *s, const struct ted4_prior *prior, unsigned tile,
                    void *work);

#endif
