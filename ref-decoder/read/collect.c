/* collect.c - finds every error of an invalid file, as far as parsing can continue. The functions
 * of the strict decoder do the checks; an error that they find is repaired in a copy of the file,
 * and they are called again. Nothing is checked that depends on a wrong value (R-ERR-003): no other
 * payload if HEAD is wrong, no tile if the networks or positions are wrong, and not the hash in
 * ENDS if anything is wrong.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "read/collect.h"

#include <string.h>
#include <xxhash.h>
#include "base/bytes.h"
#include "norm/limits.h"
#include "norm/scene.h"
#include "read/collect_payload.h"

/* Reports an error of the file header. Returns 1 if the search can go on. */
static int judge_file_header(ted4_collector *c)
{
    ted4_reader r;
    ted4_status code;

    ted4_reader_init(&r, c->copy, 0, c->f->size, 1);
    c->level = ted4_container_header(&r, &c->d.s->profile);
    code = r.base.error.code;
    if (code == TED4_OK)
        return 1;
    ted4_find_error(c->f, r.base.error);
    if (code == TED4_E_CON_LEVEL)
        c->level = TED4_LEVEL_UNBOUNDED;
    return code == TED4_E_CON_LEVEL || code == TED4_E_LVL_EXCEEDED;
}

static void store_hash(ted4_collector *c, const ted4_chunk_place *p)
{
    ted4_store64(c->copy + p->end, XXH3_64bits(c->copy + p->at, p->end - p->at));
}

/* Returns the type of a chunk after which the chunk at offset at is not out of order (-1: it may be
 * the first). There is such a type for every chunk. */
static int order_that_fits(ted4_reader r, size_t at)
{
    int before = -2, after;

    do {
        after = ++before;
        r.base.pos = at;
        r.base.error.code = TED4_OK;
        (void)ted4_container_judge(&r, &after);
    } while (r.base.error.code == TED4_E_CON_CHUNK_ORDER);
    return before;
}

/* Repairs an error of a frame so that the chunk can be checked again, as one that follows *before.
 * Returns 1, or 0 if no more checks of the frame are possible. */
static int repair_frame(ted4_collector *c, const ted4_reader *r, const ted4_chunk_place *p,
                        ted4_error e, int *before)
{
    switch (e.code) {
    case TED4_E_CON_CHUNK_HASH: break;
    case TED4_E_CON_CHUNK_ORDER: *before = order_that_fits(*r, p->at); break;
    case TED4_E_CON_RESERVED:
        if (e.offset == p->at)
            return 0;
        ted4_store32(c->copy + p->at + 4, p->type < TED4_CHUNKS ? (uint32_t)TED4_FLAG_CRITICAL : 0);
        break;
    default: return 0;
    }
    store_hash(c, p);
    return 1;
}

/* Reports every error of one frame. Returns 1, or 0 if the chunk does not fit in the file. */
static int judge_frame(ted4_collector *c, ted4_reader *r, int *before)
{
    const size_t at = r->base.pos;
    int b = *before, again = 1;

    while (again) {
        ted4_chunk_place p;
        int after = b;

        r->base.pos = at;
        r->base.error.code = TED4_OK;
        p = ted4_container_judge(r, &after);
        if (r->base.error.code != TED4_OK)
            ted4_find_error(c->f, r->base.error);
        if (r->base.error.code == TED4_E_CON_TRUNCATED)
            return 0;
        c->wrong |= r->base.error.code == TED4_E_CON_CHUNK_HASH;
        c->disordered |= r->base.error.code == TED4_E_CON_CHUNK_ORDER;
        again = r->base.error.code != TED4_OK && repair_frame(c, r, &p, r->base.error, &b);
        if (p.type < TED4_CHUNKS)
            *before = p.type;
    }
    r->base.error.code = TED4_OK;
    return 1;
}

/* Runs pass 1 of spec 5.3. Returns the offset behind the last complete chunk. */
static size_t judge_frames(ted4_collector *c)
{
    ted4_reader r;
    size_t end = TED4_FILE_HEADER_SIZE;
    int before = -1;

    ted4_reader_init(&r, c->copy, end, c->f->size, 1);
    while (before != TED4_ENDS && judge_frame(c, &r, &before))
        end = r.base.pos;
    if (before == TED4_ENDS && end < c->f->size)
        ted4_find_error(c->f, (ted4_error) { TED4_E_CON_TRAILING, end });
    if (before != TED4_ENDS) /* the file is truncated, and its full size is not known */
        c->d.file_bytes = ted4_limits_of(c->level)->file_bytes;
    return end;
}

static void judge_ends(ted4_collector *c, const ted4_chunk_place *p)
{
    ted4_reader r = ted4_decoder_reader(&c->d, p);
    const size_t size = sizeof c->d.s->hash;

    if (c->n_tile_chunks < c->d.s->shape.n_tiles && !c->disordered) {
        ted4_fail(&c->d.file.base.error, TED4_E_CON_CHUNK_ORDER, p->at);
        (void)ted4_collect_error(c);
    }
    if (!c->wrong && !c->disordered) {
        ted4_decoder_chunk(&c->d, p);
        (void)ted4_collect_error(c);
        return;
    }
    ted4_walk_ends(&r.base, p->end - p->payload >= size ? c->copy + p->payload : c->d.s->hash);
    ted4_require(&r.base, r.base.pos == r.end, TED4_E_CON_PAYLOAD_SIZE, r.base.pos);
    c->d.file.base.error = r.base.error;
    (void)ted4_collect_error(c);
}

static void judge_payload(ted4_collector *c, const ted4_chunk_place *p)
{
    ted4_scene *s = c->d.s;

    switch (p->type) {
    case TED4_HEAD: ted4_collect_head(c, p); break;
    case TED4_NETE: ted4_collect_nete(c, p); break;
    case TED4_NETR: ted4_collect_blob(c, p, "netr", &s->netr); break;
    case TED4_BANK: ted4_collect_blob(c, p, "bank", &s->bank); break;
    case TED4_POSN: ted4_collect_positions(c, p); break;
    case TED4_TILE: ted4_collect_tile(c, p); break;
    default: judge_ends(c, p);
    }
}

/* Runs pass 2 of spec 5.3 up to offset end. */
static void judge_payloads(ted4_collector *c, size_t end)
{
    ted4_reader r;
    int seen[TED4_CHUNKS + 1] = { 0 };

    ted4_reader_init(&r, c->copy, TED4_FILE_HEADER_SIZE, c->f->size, 1);
    while (r.base.pos < end) {
        const ted4_chunk_place p = ted4_container_next(&r);

        if (p.type < TED4_CHUNKS && (p.type == TED4_HEAD || c->head) &&
            (!seen[p.type] || p.type == TED4_TILE))
            judge_payload(c, &p);
        seen[p.type] = 1;
    }
    ted4_decoder_finish(&c->d);
}

ted4_status ted4_collect(ted4_findings *f, const ted4_options *o)
{
    ted4_options own = *o;
    ted4_collector c;
    ted4_status code = TED4_E_LIMIT_MEMORY;

    memset(&c, 0, sizeof c);
    own.parallel = NULL; /* tiles are checked one by one */
    if (!ted4_decoder_init(&c.d, f->data, f->size, &own))
        return code;
    c.f = f;
    c.copy = ted4_arena_alloc(&c.d.s->arena, f->size, 1);
    if (c.copy != NULL) {
        code = TED4_OK;
        if (f->size > 0)
            memcpy(c.copy, f->data, f->size);
        c.d.file.data = c.copy;
        if (judge_file_header(&c))
            judge_payloads(&c, judge_frames(&c));
    }
    ted4_scene_free(c.d.s);
    return code;
}
