/* decode.c - ted4_decode(): runs pass 1, then pass 2 chunk by chunk, with tiles in batches
 * (spec 5.3).
 * SPDX-License-Identifier: BSD-2-Clause */
#include "read/decode.h"

#include <stdatomic.h>
#include <string.h>
#include "kernel/int_kernel.h"
#include "norm/limits.h"
#include "norm/scene.h"
#include "read/inflate.h"

/* The maximum number of tiles decoded at the same time, and the maximum size of their work areas
 * together. One tile may always be decoded. */
enum { BATCH = 16, BATCH_BYTES = 1 << 28 };

/* Each queued tile has its own coder. While it is decoded it also has a work area: the first one
 * that is free, since that one is most likely still in the cache. There are as many work areas as
 * tiles that can be decoded at the same time. */
struct ted4_tile_job {
    ted4_reader reader;
    unsigned number;
    void *work; /* work area i, for any of the tiles; so is its flag busy */
    atomic_flag busy;
};

typedef ted4_decoder decoder;
typedef struct ted4_tile_job job;

/* Fails because memory has run out, with offset at as the place of the error. */
static void no_memory(decoder *d, size_t at)
{
    ted4_fail(&d->file.base.error, TED4_E_LIMIT_MEMORY, at);
}

ted4_reader ted4_decoder_reader(decoder *d, const ted4_chunk_place *p)
{
    ted4_reader r;

    ted4_reader_init(&r, d->file.data, p->payload, p->end, 0);
    r.arena = &d->s->arena;
    r.many = d->many;
    r.base.trace = d->o->trace;
    r.base.trace_user = d->o->trace_user;
    return r;
}

/* Checks that a payload has been read to its end, and takes over its error. */
static void finish_payload(decoder *d, ted4_reader *r)
{
    ted4_require(&r->base, r->base.pos == r->end, TED4_E_CON_PAYLOAD_SIZE, r->base.pos);
    if (r->base.error.code != TED4_OK)
        ted4_fail(&d->file.base.error, r->base.error.code, r->base.error.offset);
}

static void read_head(decoder *d, const ted4_chunk_place *p)
{
    ted4_reader r = ted4_decoder_reader(d, p);

    ted4_walk_header(&r.base, &d->s->head, &d->s->shape, d->s->level, d->file_bytes);
    if (r.base.error.code == TED4_OK && d->o->max_work > 0 &&
        ted4_count_work(&d->s->head, &d->s->shape, d->file.end) > d->o->max_work)
        ted4_fail(&r.base.error, TED4_E_LIMIT_WORK, p->payload);
    finish_payload(d, &r);
}

/* Allocates n values, but only if the payload can hold them, in its mode, behind its first skip
 * bytes (R-LVL-005). */
static void prepare_blob(decoder *d, const ted4_chunk_place *p, size_t skip, ted4_blob *b,
                         uint64_t n)
{
    const size_t bytes = p->end - p->payload;
    const size_t left = bytes > skip ? bytes - skip - 1 : 0;
    const uint8_t mode = bytes > skip ? d->file.data[p->payload + skip] : TED4_BLOB_RAW;

    b->n = n;
    if (mode == TED4_BLOB_RAW     ? left / 4 < n
        : mode == TED4_BLOB_CODED ? left < ted4_rest_least(n)
                                  : ted4_inflate_impossible(left, n))
        return;
    if (!ted4_blob_alloc(d->s, b, n))
        no_memory(d, p->payload);
    /* Units are not more than values. */
    if (mode == TED4_BLOB_CODED && b != &d->s->nete) {
        b->exponent = ted4_arena_alloc(&d->s->arena, n, 1);
        if (b->exponent == NULL)
            no_memory(d, p->payload);
    }
}

static void read_nete(decoder *d, const ted4_chunk_place *p)
{
    const ted4_shape *shape = &d->s->shape;
    ted4_reader r = ted4_decoder_reader(d, p);

    prepare_blob(d, p, shape->n_units, &d->s->nete, shape->n_nete);
    if (!ted4_scene_alloc_shifts(d->s) ||
        (d->s->nete.values != NULL &&
         ted4_prior_init(&d->prior, &d->s->head, shape, &d->s->arena) != TED4_OK))
        no_memory(d, p->payload);
    d->prior.dense = ted4_select_int_dense();
    if (d->file.base.error.code != TED4_OK)
        return;
    ted4_walk_nete(&r.base, d->s, &d->prior);
    finish_payload(d, &r);
}

static void read_blob(decoder *d, const ted4_chunk_place *p, const char *element, ted4_blob *b,
                      uint64_t n)
{
    ted4_reader r = ted4_decoder_reader(d, p);

    prepare_blob(d, p, 0, b, n);
    if (d->file.base.error.code != TED4_OK)
        return;
    ted4_walk_blob(&r.base, element, d->s, b);
    finish_payload(d, &r);
}

/* Allocates as many work areas as tiles can be decoded at the same time, or fewer if memory runs
 * out. Fails only if there is memory for none. */
static void prepare_jobs(decoder *d, size_t at)
{
    ted4_arena *a = &d->s->arena;
    const size_t size = ted4_tile_work_size(d->s);
    unsigned want = d->s->shape.n_tiles < BATCH ? d->s->shape.n_tiles : BATCH;

    if (want > BATCH_BYTES / size)
        want = BATCH_BYTES / size > 0 ? (unsigned)(BATCH_BYTES / size) : 1;
    if (d->o->parallel == NULL || d->o->trace != NULL)
        want = 1;
    d->jobs = ted4_arena_alloc(a, want, sizeof *d->jobs);
    if (d->jobs == NULL) {
        no_memory(d, at);
        return;
    }
    for (; d->n_workspaces < want; d->n_workspaces++) {
        d->jobs[d->n_workspaces].work = ted4_arena_alloc_raw(a, 1, size);
        if (d->jobs[d->n_workspaces].work == NULL)
            break;
        atomic_flag_clear(&d->jobs[d->n_workspaces].busy);
    }
    if (d->n_workspaces == 0)
        no_memory(d, at);
}

static void read_positions(decoder *d, const ted4_chunk_place *p)
{
    ted4_reader r = ted4_decoder_reader(d, p);
    const uint32_t n = d->s->head.n_anchors;
    const size_t size = p->end - p->payload;

    if (d->s->profile == TED4_PROFILE_COMPACT ? size > ted4_rest_least(n) : size / 6 >= n) {
        if (!ted4_scene_alloc_anchors(d->s))
            no_memory(d, p->payload);
        else
            prepare_jobs(d, p->payload);
        if (d->file.base.error.code != TED4_OK)
            return;
    }
    ted4_walk_positions(&r.base, d->s);
    finish_payload(d, &r);
}

static void run_job(void *arg, size_t i)
{
    decoder *d = arg;
    job *j = &d->jobs[i], *area = d->jobs;

    while (atomic_flag_test_and_set(&area->busy))
        area++;
    ted4_walk_tile(&j->reader.base, d->s, &d->prior, j->number, area->work);
    atomic_flag_clear(&area->busy);
}

/* Decodes the queued tiles and takes over their errors in the order of the file, so that the error
 * with the lowest offset counts. */
static void run_batch(decoder *d)
{
    ted4_parallel_for(d->o->parallel, d->n_queued, run_job, d);
    for (unsigned i = 0; i < d->n_queued; i++) {
        finish_payload(d, &d->jobs[i].reader);
        d->n_good += d->file.base.error.code == TED4_OK;
    }
    d->n_queued = 0;
}

static void read_tile(decoder *d, const ted4_chunk_place *p)
{
    job *j;

    if (d->n_tiles == d->s->shape.n_tiles) {
        run_batch(d);
        ted4_fail(&d->file.base.error, TED4_E_CON_CHUNK_ORDER, p->at);
        return;
    }
    j = &d->jobs[d->n_queued++];
    j->reader = ted4_decoder_reader(d, p);
    j->number = d->n_tiles++;
    if (d->n_queued == d->n_workspaces)
        run_batch(d);
}

static void read_ends(decoder *d, const ted4_chunk_place *p)
{
    ted4_reader r = ted4_decoder_reader(d, p);

    run_batch(d);
    if (d->n_tiles < d->s->shape.n_tiles)
        ted4_fail(&d->file.base.error, TED4_E_CON_CHUNK_ORDER, p->at);
    if (d->file.base.error.code != TED4_OK)
        return;
    ted4_scene_hash(d->s, d->s->hash);
    ted4_walk_ends(&r.base, d->s->hash);
    finish_payload(d, &r);
}

void ted4_decoder_chunk(decoder *d, const ted4_chunk_place *p)
{
    ted4_scene *s = d->s;

    if (p->type == TED4_BANK ? s->shape.n_bank == 0
                             : p->type == TED4_POSN && s->shape.n_bank > 0 && s->bank.n == 0) {
        ted4_fail(&d->file.base.error, TED4_E_CON_CHUNK_ORDER, p->at);
        return;
    }
    switch (p->type) {
    case TED4_HEAD: read_head(d, p); break;
    case TED4_NETE: read_nete(d, p); break;
    case TED4_NETR: read_blob(d, p, "netr", &s->netr, s->shape.n_netr); break;
    case TED4_BANK: read_blob(d, p, "bank", &s->bank, s->shape.n_bank); break;
    case TED4_POSN: read_positions(d, p); break;
    case TED4_TILE: read_tile(d, p); break;
    case TED4_ENDS: read_ends(d, p); break;
    default:
        if (p->end > p->payload)
            ted4_trace(&d->file.base, p->payload, "ancillary", 0, (int64_t)(p->end - p->payload));
    }
}

/* Runs pass 2 of spec 5.3. */
static void read_payloads(decoder *d)
{
    ted4_coder *c = &d->file.base;

    c->pos = 0;
    c->trace = d->o->trace;
    c->trace_user = d->o->trace_user;
    ted4_walk_file_header(c, 0, &d->s->profile, &d->s->level);
    while (c->error.code == TED4_OK && c->pos < d->file.end) {
        const ted4_chunk_place p = ted4_container_next(&d->file);

        ted4_decoder_chunk(d, &p);
        ted4_trace(c, p.end, "chunk_hash", 0, (int64_t)ted4_load64(d->file.data + p.end));
    }
    ted4_decoder_finish(d);
}

int ted4_decoder_init(decoder *d, const void *data, size_t size, const ted4_options *o)
{
    static const ted4_options standard = { .max_bytes = 0 };

    memset(d, 0, sizeof *d);
    d->o = o != NULL ? o : &standard;
    d->file_bytes = size;
    d->many = ted4_select_gauss_many();
    ted4_reader_init(&d->file, data, 0, size, 1);
    d->s = ted4_scene_empty(o);
    if (d->s == NULL)
        no_memory(d, 0);
    return d->s != NULL;
}

void ted4_decoder_finish(decoder *d)
{
    run_batch(d);
    for (unsigned i = 0; i < d->n_workspaces; i++)
        ted4_arena_release(&d->s->arena, d->jobs[i].work);
    ted4_arena_release(&d->s->arena, d->jobs);
    d->jobs = NULL;
    d->n_workspaces = 0;
}

ted4_status ted4_decode(const void *data, size_t size, const ted4_options *o, ted4_scene **scene,
                        ted4_error *e)
{
    ted4_reader whole;
    decoder d;
    ted4_error verdict;

    *scene = NULL;
    ted4_reader_init(&whole, data, 0, size, 1);
    ted4_container_check(&whole);
    verdict = whole.base.error;
    if (verdict.code == TED4_OK) {
        if (ted4_decoder_init(&d, data, size, o))
            read_payloads(&d);
        verdict = d.file.base.error;
        if (verdict.code == TED4_OK)
            *scene = d.s;
        else
            ted4_scene_free(d.s);
    }
    if (e != NULL)
        *e = verdict;
    return verdict.code;
}
