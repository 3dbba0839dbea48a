/* coder.h - the interface between walks and coders. A walk (walk_*.c) describes a syntax structure
 * once: its elements, their order, contexts and limits. A coder decides whether the walk reads,
 * writes or counts: it handles bytes and slots. Any coder can be traced. The coders are
 * read/reader.c, ref-encoder/write/coder_write.c and coder_count.c.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_CODER_H
#define TED4_CODER_H

#include "norm/syntax.h"

typedef struct ted4_coder ted4_coder;

/* The operations of a coder. Each receives the value to be coded and returns the coded value: a
 * reading coder ignores the value that it receives, and the other coders return it. After an error,
 * operations do nothing, and numbers are 0. */
typedef struct {
    /* Codes an unsigned number of 1, 2 or 4 bytes. */
    uint32_t (*number)(ted4_coder *c, unsigned width, uint32_t value);
    /* Codes an array of n numbers of width bytes each. If too few bytes remain, values is not
     * accessed: n may then be an unchecked number from the file, even beyond size_t, and values may
     * be NULL. */
    void (*array)(ted4_coder *c, unsigned width, void *values, uint64_t n);
    /* spec 7.2, mode 1: codes the zlib bytes up to the end of the chunk. A reader also inflates
     * them into b->values. */
    void (*deflated)(ted4_coder *c, ted4_blob *b);
    /* spec 9.1: codes size[n]. A writer fills in the sizes later, in close. */
    void (*sizes)(ted4_coder *c, uint32_t *size, unsigned n);
    /* spec 9.2: begin the next substream, which has n symbols, and end it. */
    void (*open)(ted4_coder *c, size_t n);
    void (*close)(ted4_coder *c);
    /* spec 9.3: codes one binary symbol, whose value is 1 for slots in [0, prob). */
    int (*bit)(ted4_coder *c, uint32_t prob, int value);
    /* spec 9.4: codes k[n], where symbol i has the Gaussian model with mu[i] (Q8) and the sigma
     * index sigma[i]. */
    void (*gauss)(ted4_coder *c, size_t n, const int32_t *mu, const uint8_t *sigma, int16_t *k);
    /* spec 9.5: says that the next substream, which stands for n anchors or values, takes the rest
     * of the payload. It is then opened with one symbol, as it has one lane. */
    void (*rest)(ted4_coder *c, uint64_t n);
} ted4_coder_ops;

struct ted4_coder {
    const ted4_coder_ops *ops;
    int reads;        /* 1: the coder produces values; 0: it consumes them */
    size_t pos;       /* byte offset in the file of the next element */
    ted4_error error; /* the first error */
    void (*trace)(void *user, size_t offset, const char *element, int64_t index,
                  int64_t value); /* see ted4_options; NULL: no trace */
    void *trace_user;
};

/* spec 9.5: returns the least size in bytes of a substream that stands for n anchors or values. */
static inline uint64_t ted4_rest_least(uint64_t n)
{
    return n / 8 + (n % 8 != 0);
}

/* Records the error code at byte offset at unless holds is true. Returns holds. */
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

/* Codes and traces one number of width bytes. index is the number's index in an array, or 0 if the
 * element is not an array. Returns the coded value. */
static inline uint32_t ted4_code(ted4_coder *c, const char *element, int64_t index, unsigned width,
                                 uint32_t value)
{
    const size_t at = c->pos;

    value = c->ops->number(c, width, value);
    ted4_trace(c, at, element, index, value);
    return value;
}

/* walk_container.c - spec 5. A frame is the part of a chunk around its payload. */
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

/* The chunk types of R-CON-003, in their order. */
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

/* Codes the magic bytes, the version, the profile and the level. minor is what a writer writes. */
void ted4_walk_file_header(ted4_coder *c, unsigned minor, uint8_t *profile, uint8_t *level);
/* Codes the type, the flags and the size. */
void ted4_walk_frame(ted4_coder *c, ted4_frame *f);
/* spec 15.2: codes the payload of ENDS, which must equal hash[16]. */
void ted4_walk_ends(ted4_coder *c, const uint8_t *hash);

/* walk_header.c - spec 6.1: codes *h and fills *shape. file_bytes, the size of the file, is needed
 * for the bounds of spec 13; UINT64_MAX: it is not known yet, and these bounds are not checked. */
void ted4_walk_header(ted4_coder *c, ted4_header *h, ted4_shape *shape, unsigned level,
                      uint64_t file_bytes);

/* walk_nets.c - spec 7. The caller has allocated the values of the blobs and, for mode 2, their
 * exponents, or left them NULL where the payload is too short for them; a reader does not access
 * the latter. */
struct ted4_prior;
void ted4_walk_nete(ted4_coder *c, ted4_scene *s, struct ted4_prior *prior);
/* b: s->netr or s->bank. */
void ted4_walk_blob(ted4_coder *c, const char *element, const ted4_scene *s, ted4_blob *b);

/* walk_coded.c - spec 7.6: the rest of a blob of mode 2, behind its mode. b: s->nete, s->netr or
 * s->bank. Returns the byte offset of the substream, at which its errors are found. */
size_t ted4_walk_coded(ted4_coder *c, const ted4_scene *s, ted4_blob *b);

/* walk_positions.c - spec 8. */
void ted4_walk_positions(ted4_coder *c, ted4_scene *s);

/* walk_tile.c - spec 9, 10. work points to ted4_tile_work_size() bytes, aligned to 64 bytes, whose
 * contents do not matter. */
size_t ted4_tile_work_size(const ted4_scene *s); /* SIZE_MAX: more than this machine can address */
void ted4_walk_tile(ted4_coder *c, ted4_scene *s, const struct ted4_prior *prior, unsigned tile,
                    void *work);

#endif
