/* write_file.c - ted4_encode(): writes the chunks of a file in order (spec 5), with the walks of
 * norm/.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "write/encode.h"

#include <stdlib.h>
#include <string.h>
#include <xxhash.h>
#include "base/bytes.h"
#include "norm/limits.h"
#include "write/coded.h"
#include "write/coder_write.h"
#include "write/deflate.h"
#include "write/tiles.h"

enum { LEVEL_BYTE = 11, META_FLAGS = 2, COMPACT_MINOR = 2 };

/* Writes the type, the flags and a size of 0, which close_chunk corrects. Returns the offset of the
 * chunk. */
static size_t open_chunk(ted4_writer *w, ted4_chunk type)
{
    const size_t at = w->base.pos;
    ted4_frame f;

    memcpy(f.type, ted4_chunk_type[type], sizeof f.type);
    f.flags = TED4_FLAG_CRITICAL;
    f.size = 0;
    ted4_walk_frame(&w->base, &f);
    return at;
}

static void close_chunk(ted4_writer *w, size_t at)
{
    ted4_coder *c = &w->base;
    const size_t size = c->pos - at - TED4_FRAME_HEAD_SIZE;
    uint64_t hash;

    /* After a failure, the chunk may not even have begun. */
    if (c->error.code != TED4_OK)
        return;
    if (!ted4_require(c, size <= UINT32_MAX, TED4_E_LVL_EXCEEDED, at))
        return;
    ted4_store32(w->out.data + at + 8, (uint32_t)size);
    hash = XXH3_64bits(w->out.data + at, c->pos - at);
    c->ops->number(c, 4, (uint32_t)hash);
    c->ops->number(c, 4, (uint32_t)(hash >> 32));
}

/* Chooses the mode of a blob of s that has none: the smallest that the profile has. */
static void choose_mode(const ted4_scene *s, ted4_blob *b, ted4_arena *arena, ted4_error *e)
{
    uint8_t *bytes, *packed;
    size_t size;

    if (b->mode != TED4_BLOB_AUTO || b->n == 0)
        return;
    b->mode = TED4_BLOB_RAW;
    bytes = ted4_arena_alloc(arena, b->n, 4);
    packed = ted4_arena_alloc(arena, ted4_deflate_bound(b->n), 1);
    if (bytes == NULL || packed == NULL) {
        ted4_fail(e, TED4_E_LIMIT_MEMORY, 0);
        return;
    }
    if (ted4_deflate(b->values, b->n, bytes, packed, &size)) {
        b->mode = TED4_BLOB_DEFLATED;
        b->deflated = packed;
        b->deflated_size = size;
    }
    if (s->profile == TED4_PROFILE_COMPACT)
        (void)ted4_blob_code(s, b, arena, b->mode == TED4_BLOB_RAW ? 4 * b->n : size);
}

static void write_blob(ted4_writer *w, ted4_chunk type, const ted4_scene *s, ted4_blob *b)
{
    const size_t at = open_chunk(w, type);

    ted4_walk_blob(&w->base, "value", s, b);
    close_chunk(w, at);
}

/* Writes the chunks between the header and the tiles. */
static void write_front(ted4_writer *w, ted4_draft *d)
{
    ted4_coder *c = &w->base;
    size_t at;

    choose_mode(&d->s, &d->s.nete, &d->arena, &c->error);
    choose_mode(&d->s, &d->s.netr, &d->arena, &c->error);
    choose_mode(&d->s, &d->s.bank, &d->arena, &c->error);
    if (d->s.profile == TED4_PROFILE_COMPACT && d->s.grid == 0)
        d->s.grid = (uint8_t)ted4_coarsest_grid(d->s.position, d->s.head.n_anchors);
    at = open_chunk(w, TED4_NETE);
    ted4_walk_nete(c, &d->s, &d->prior);
    close_chunk(w, at);
    write_blob(w, TED4_NETR, &d->s, &d->s.netr);
    if (d->s.shape.n_bank > 0)
        write_blob(w, TED4_BANK, &d->s, &d->s.bank);
    at = open_chunk(w, TED4_POSN);
    ted4_walk_positions(c, &d->s);
    close_chunk(w, at);
}

/* Writes text for human readers, which no decoder needs. */
static void write_meta(ted4_writer *w, char *text)
{
    const size_t at = w->base.pos;
    ted4_frame f = { .type = { 'M', 'E', 'T', 'A' }, .flags = META_FLAGS };

    if (w->base.error.code != TED4_OK || text == NULL)
        return;
    ted4_walk_frame(&w->base, &f);
    w->base.ops->array(&w->base, 1, text, strlen(text));
    close_chunk(w, at);
}

static void append_tile(ted4_writer *w, const ted4_writer *tile)
{
    const size_t at = open_chunk(w, TED4_TILE);

    w->base.ops->array(&w->base, 1, tile->out.data, tile->out.size);
    close_chunk(w, at);
}

static void write_tiles(ted4_writer *w, ted4_draft *d, const ted4_parallel *p)
{
    const size_t n_tiles = d->s.shape.n_tiles;
    ted4_writer *tiles;
    ted4_error e;

    if (w->base.error.code != TED4_OK)
        return;
    tiles = ted4_arena_alloc(&d->arena, n_tiles, sizeof *tiles);
    if (!ted4_require(&w->base, tiles != NULL, TED4_E_LIMIT_MEMORY, 0))
        return;
    for (size_t i = 0; i < n_tiles; i++)
        ted4_writer_init(&tiles[i]);
    e = ted4_draft_tiles(d, tiles, sizeof *tiles, p);
    if (e.code != TED4_OK)
        ted4_fail(&w->base.error, e.code, e.offset);
    for (size_t i = 0; i < n_tiles; i++) {
        if (w->base.error.code == TED4_OK)
            append_tile(w, &tiles[i]);
        ted4_writer_finish(&tiles[i]);
    }
}

static void write_ends(ted4_writer *w, ted4_draft *d)
{
    const size_t at = open_chunk(w, TED4_ENDS);

    ted4_scene_hash(&d->s, d->s.hash);
    ted4_walk_ends(&w->base, d->s.hash);
    close_chunk(w, at);
}

/* Stores the level of a finished file. If level is 0, that is the lowest that fits. */
static void set_level(ted4_writer *w, const ted4_scene *s, int level)
{
    if (w->base.error.code != TED4_OK)
        return;
    if (level == 0)
        level = (int)ted4_level_lowest(&s->head, &s->shape, w->out.size);
    else
        ted4_require(&w->base,
                     ted4_limits_hold(ted4_limits_of((unsigned)level), &s->head, &s->shape,
                                      w->out.size),
                     TED4_E_LVL_EXCEEDED, LEVEL_BYTE);
    w->out.data[LEVEL_BYTE] = (uint8_t)level;
}

static void write_file(ted4_writer *w, const ted4_scene *s, int level, char *text,
                       const ted4_parallel *p)
{
    ted4_coder *c = &w->base;
    uint8_t declared = (uint8_t)(level == 0 ? TED4_LEVEL_UNBOUNDED : level), profile = s->profile;
    ted4_header head = s->head;
    ted4_shape shape;
    ted4_draft d;
    size_t at;

    /* R-CON-007: the lowest minor version that has the profile. */
    ted4_walk_file_header(c, profile == TED4_PROFILE_MAIN ? 0 : COMPACT_MINOR, &profile, &declared);
    at = open_chunk(w, TED4_HEAD);
    if (c->error.code == TED4_OK)
        ted4_walk_header(c, &head, &shape, declared, UINT64_MAX);
    close_chunk(w, at);
    if (c->error.code != TED4_OK)
        return;
    ted4_fail(&c->error, ted4_draft_init(&d, s), c->pos);
    if (c->error.code == TED4_OK) {
        write_front(w, &d);
        write_tiles(w, &d, p);
        write_meta(w, text);
        write_ends(w, &d);
    }
    ted4_draft_finish(&d);
    set_level(w, s, level);
}

ted4_status ted4_encode(const ted4_scene *s, int level, const ted4_parallel *p, uint8_t **out,
                        size_t *size, ted4_error *e)
{
    return ted4_encode_with_text(s, level, NULL, p, out, size, e);
}

ted4_status ted4_encode_with_text(const ted4_scene *s, int level, char *text,
                                  const ted4_parallel *p, uint8_t **out, size_t *size,
                                  ted4_error *e)
{
    ted4_writer w;
    ted4_status verdict;

    ted4_writer_init(&w);
    write_file(&w, s, level, text, p);
    verdict = w.base.error.code;
    if (e != NULL)
        *e = w.base.error;
    *out = NULL;
    *size = 0;
    if (verdict == TED4_OK) {
        *out = w.out.data;
        *size = w.out.size;
        w.out.data = NULL;
    }
    ted4_writer_finish(&w);
    return verdict;
}
