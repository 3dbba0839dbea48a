/* container.c - checks chunk frames, hashes and the order of chunks (spec 5).
 * SPDX-License-Identifier: BSD-2-Clause */
#include "read/container.h"

#include <string.h>
#include <xxhash.h>
#include "norm/limits.h"

static int chunk_of(const uint8_t *type)
{
    int i = 0;

    while (i < TED4_CHUNKS && memcmp(type, ted4_chunk_type[i], 4) != 0)
        i++;
    return i;
}

static int legal_type(const uint8_t *type)
{
    for (int i = 0; i < 4; i++)
        if (!((type[i] >= '0' && type[i] <= '9') || (type[i] >= 'A' && type[i] <= 'Z') ||
              (type[i] >= 'a' && type[i] <= 'z')))
            return 0;
    return 1;
}

/* Returns 1 if a known chunk may follow the known chunk before it (-1: none), by R-CON-003. The
 * presence of BANK and the number of TILE chunks are checked in pass 2. */
static int may_follow(int before, int type)
{
    switch (type) {
    case TED4_POSN: return before == TED4_NETR || before == TED4_BANK;
    case TED4_TILE: return before == TED4_POSN || before == TED4_TILE;
    default: return before == type - 1;
    }
}

/* Checks R-CON-002 to R-CON-004 for a chunk that fits in the file. *before is the type of the last
 * known chunk, and is updated. */
static void judge(ted4_reader *r, size_t at, const ted4_frame *f, int *before)
{
    ted4_coder *c = &r->base;
    const size_t hashed = TED4_FRAME_HEAD_SIZE + f->size;
    const int type = chunk_of(f->type), known = type < TED4_CHUNKS;

    ted4_require(c, XXH3_64bits(r->data + at, hashed) == ted4_load64(r->data + at + hashed),
                 TED4_E_CON_CHUNK_HASH, at);
    ted4_require(c, legal_type(f->type), TED4_E_CON_RESERVED, at);
    ted4_require(c, known ? may_follow(*before, type) : *before >= 0, TED4_E_CON_CHUNK_ORDER, at);
    ted4_require(c,
                 known ? f->flags == TED4_FLAG_CRITICAL
                       : f->flags <= (TED4_FLAG_CRITICAL | TED4_FLAG_COPY),
                 TED4_E_CON_RESERVED, at + 4);
    ted4_require(c, known || (f->flags & TED4_FLAG_CRITICAL) == 0, TED4_E_CON_UNKNOWN_CRITICAL, at);
    if (known)
        *before = type;
}

uint8_t ted4_container_header(ted4_reader *r, uint8_t *profile)
{
    ted4_coder *c = &r->base;
    uint8_t level = 0;

    ted4_walk_file_header(c, 0, profile, &level);
    if (c->error.code == TED4_OK)
        ted4_require(c, r->end <= ted4_limits_of(level)->file_bytes, TED4_E_LVL_EXCEEDED,
                     c->pos - 1);
    return level;
}

/* Returns the chunk whose frame begins at offset at and was just read, and moves r's position
 * behind the chunk. */
static ted4_chunk_place pass_over(ted4_reader *r, size_t at, const ted4_frame *f)
{
    ted4_chunk_place p = { .at = at, .payload = r->base.pos };

    p.type = chunk_of(f->type);
    p.end = p.payload + f->size;
    r->base.pos = p.end + TED4_FRAME_HASH_SIZE;
    return p;
}

ted4_chunk_place ted4_container_judge(ted4_reader *r, int *before)
{
    static const ted4_chunk_place none = { 0, 0, 0, TED4_CHUNKS };
    ted4_coder *c = &r->base;
    const size_t at = c->pos;
    ted4_frame f;

    memset(&f, 0, sizeof f);
    ted4_walk_frame(c, &f);
    if (c->error.code != TED4_OK)
        return none;
    if (r->end - c->pos < (uint64_t)f.size + TED4_FRAME_HASH_SIZE) {
        ted4_fail(&c->error, TED4_E_CON_TRUNCATED, r->end);
        return none;
    }
    judge(r, at, &f, before);
    return pass_over(r, at, &f);
}

void ted4_container_check(ted4_reader *r)
{
    ted4_coder *c = &r->base;
    int before = -1;
    uint8_t profile = 0;

    (void)ted4_container_header(r, &profile);
    while (c->error.code == TED4_OK && before != TED4_ENDS)
        (void)ted4_container_judge(r, &before);
    ted4_require(c, c->pos == r->end, TED4_E_CON_TRAILING, c->pos);
}

ted4_chunk_place ted4_container_next(ted4_reader *r)
{
    const size_t at = r->base.pos;
    ted4_frame f;

    memset(&f, 0, sizeof f);
    ted4_walk_frame(&r->base, &f);
    return pass_over(r, at, &f);
}
