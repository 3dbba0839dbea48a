/* recon.c - answers queries (spec 11): allocates memory, decides which results have to be computed,
 * and distributes blocks over threads. load.c fills the memory, heads.c computes the records. The
 * records of the last query are kept, and a query computes again only what its time and camera
 * change.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "kernel/strict_dense.h"
#include "norm/limits.h"
#include "recon/recon.h"

enum { MAX_CHUNKS = 64, BLOCKS_PER_CHUNK = 16 };

/* Allocates as ted4_arena_alloc does, and sets *ok to 0 if that fails. */
static void *take(ted4_arena *a, int *ok, size_t n, size_t size)
{
    void *p = ted4_arena_alloc(a, n, size);

    if (p == NULL)
        *ok = 0;
    return p;
}

static size_t blocks_of(size_t n_anchors)
{
    return (n_anchors + TED4_ROW - 1) / TED4_ROW;
}

/* Sets all sizes and counts, the networks' shapes and the dense layer's function. Returns the
 * number of records. */
static uint64_t set_sizes(ted4_recon *r, const struct ted4_scene *s)
{
    const ted4_header *h = &s->head;
    const unsigned k = h->n_offsets;
    uint64_t n_records = 0;

    r->head = *h;
    memcpy(r->net, s->shape.netr, sizeof r->net);
    r->dense = ted4_select_strict_dense();
    if (r->dense == NULL)
        r->dense = ted4_strict_dense_plain;
    r->n_motion_rows = h->motion == TED4_MOTION_INR ? TED4_POINT_INPUTS : h->phi_dim;
    r->rows = (ted4_recon_rows) { 0, 3, 3 + h->feature_dim, 0, 0, 0 };
    r->rows.size = r->rows.shift + 3 * k;
    r->rows.tau = r->rows.size + 3;
    r->rows.n = r->rows.tau + (h->activation ? 4 : 0);
    for (size_t i = 0; i < h->n_anchors; i++) {
        r->n_moving += ted4_recon_moves(s, i);
        for (unsigned j = 0; j < k; j++)
            n_records += s->offset_bits[i] >> j & 1;
    }
    r->n_static_blocks = blocks_of(h->n_anchors - r->n_moving);
    r->n_blocks = r->n_static_blocks + blocks_of(r->n_moving);
    r->n_chunks = 1 + r->n_blocks / BLOCKS_PER_CHUNK;
    if (r->n_chunks > MAX_CHUNKS)
        r->n_chunks = MAX_CHUNKS;
    return n_records;
}

static size_t larger(size_t a, size_t b)
{
    return a > b ? a : b;
}

static void take_scratch(ted4_recon *r, ted4_recon_scratch *w, int *ok)
{
    const ted4_header *h = &r->head;
    const size_t row = TED4_ROW * sizeof(float), k = h->n_offsets;
    const size_t hidden = larger(1, larger(h->deform_width, h->head_width));
    const size_t n_in = (size_t)h->feature_dim + 3;
    ted4_arena *a = &r->arena;

    w->seen = take(a, ok, n_in, row);
    w->moved = take(a, ok, n_in, row);
    w->point = take(a, ok, 3, row);
    w->deform_in = take(a, ok, larger(1, r->net[TED4_NET_DEFORM].dim[0]), row);
    w->hidden[0] = take(a, ok, hidden, row);
    w->hidden[1] = take(a, ok, hidden, row);
    w->y = take(a, ok, larger(7 * k, n_in), row);
    w->value = take(a, ok, 7 * k, row);
    w->from = take(a, ok, k * TED4_ROW, sizeof *w->from);
    w->to = take(a, ok, k * TED4_ROW, sizeof *w->to);
}

static int take_records(ted4_recon *r, size_t n)
{
    ted4_arena *a = &r->arena;
    ted4_gaussians *g = &r->out;
    int ok = 1;

    g->n = n;
    for (int c = 0; c < 3; c++) {
        g->mean[c] = take(a, &ok, n, sizeof(float));
        g->scale[c] = take(a, &ok, n, sizeof(float));
        g->colour[c] = take(a, &ok, n, sizeof(float));
    }
    for (int c = 0; c < 4; c++)
        g->rot[c] = take(a, &ok, n, sizeof(float));
    g->opacity = take(a, &ok, n, sizeof(float));
    r->opacity = r->head.activation ? take(a, &ok, n, sizeof(float)) : g->opacity;
    g->id = take(a, &ok, n, sizeof *g->id);
    return ok;
}

static int take_all(ted4_recon *r, size_t n_records)
{
    const size_t n_lanes = r->n_blocks * TED4_ROW, row = TED4_ROW * sizeof(float);
    const size_t n_moving_blocks = r->n_blocks - r->n_static_blocks;
    ted4_arena *a = &r->arena;
    int ok = 1;

    r->netr = take(a, &ok, r->n_netr, sizeof(float));
    r->bank = take(a, &ok, r->n_bank, sizeof(float));
    r->anchor = take(a, &ok, n_lanes, sizeof *r->anchor);
    r->first = take(a, &ok, n_lanes, sizeof *r->first);
    r->kept = take(a, &ok, n_lanes, sizeof *r->kept);
    r->block = take(a, &ok, r->n_blocks * r->rows.n, row);
    r->motion = take(a, &ok, n_moving_blocks * r->n_motion_rows, row);
    r->time_in = take(a, &ok, larger(r->head.bank_dim, TED4_TIME_INPUTS), sizeof(float));
    r->scratch = take(a, &ok, r->n_chunks, sizeof *r->scratch);
    for (size_t i = 0; ok && i < r->n_chunks; i++)
        take_scratch(r, &r->scratch[i], &ok);
    return ok && take_records(r, n_records);
}

ted4_status ted4_recon_new(ted4_recon **out, const ted4_scene *s, const ted4_options *o)
{
    ted4_arena arena;

    *out = NULL;
    ted4_arena_init(&arena, o);
    ted4_recon *r = ted4_arena_alloc(&arena, 1, sizeof *r);

    if (r == NULL)
        return TED4_E_LIMIT_MEMORY;
    r->arena = arena;
    r->n_netr = (size_t)s->netr.n;
    r->n_bank = (size_t)s->bank.n;
    const uint64_t n_records = set_sizes(r, s);

    if (o != NULL && o->max_work > 0 &&
        ted4_count_query_work(&s->head, &s->shape, n_records) > o->max_work) {
        ted4_recon_free(r);
        return TED4_E_LIMIT_WORK;
    }
    /* Record numbers and ids have 32 bits. */
    if ((uint64_t)s->head.n_anchors * s->head.n_offsets > UINT32_MAX ||
        !take_all(r, (size_t)n_records)) {
        ted4_recon_free(r);
        return TED4_E_LIMIT_MEMORY;
    }
    if (r->n_netr > 0)
        memcpy(r->netr, s->netr.values, r->n_netr * sizeof *r->netr);
    if (r->n_bank > 0)
        memcpy(r->bank, s->bank.values, r->n_bank * sizeof *r->bank);
    ted4_recon_load_lanes(r, s);
    ted4_recon_load_blocks(r, s, o != NULL ? o->parallel : NULL);
    *out = r;
    return TED4_OK;
}

void ted4_recon_free(ted4_recon *r)
{
    if (r == NULL)
        return;
    ted4_arena arena = r->arena; /* a copy, since r lies in the arena */

    ted4_arena_finish(&arena);
}

/* Returns the TED4_DO_ bits of the results that the new time and camera change, in moving or in
 * static blocks. */
static unsigned plan(const ted4_recon *r, const ted4_query *q, int moving)
{
    const int again = !r->fresh;
    const int turned = again || memcmp(q->camera, r->last.camera, sizeof q->camera) != 0;
    const int later = again || q->num != r->last.num || q->den != r->last.den;
    const int full = turned && r->head.view == TED4_VIEW_FULL;
    unsigned todo = 0;

    if (again || (moving && later))
        todo |= TED4_DO_MEAN | TED4_DO_COVARIANCE;
    if (full)
        todo |= TED4_DO_COVARIANCE;
    if (again || full)
        todo |= TED4_DO_OPACITY;
    if (again || (turned && r->head.view != TED4_VIEW_NONE))
        todo |= TED4_DO_COLOUR;
    if (r->head.activation && (later || full))
        todo |= TED4_DO_ACTIVATION;
    return todo;
}

static void do_chunk(void *arg, size_t chunk)
{
    const ted4_recon_job *q = arg;
    ted4_recon_scratch *w = &q->r->scratch[chunk];

    w->worst = 0;
    for (size_t i = chunk; i < q->r->n_blocks; i += q->r->n_chunks)
        ted4_recon_block(q, i, w);
}

ted4_status ted4_recon_query(ted4_recon *r, const ted4_query *q, const ted4_parallel *p,
                             ted4_gaussians *g)
{
    ted4_recon_job job = { .r = r };
    uint32_t worst = 0;

    memset(g, 0, sizeof *g);
    if (q->den < 1 || q->den >= 1u << 24 || q->num > q->den)
        return TED4_E_QUERY;
    for (int moving = 0; moving < 2; moving++)
        job.todo[moving] = plan(r, q, moving);
    const int e = r->head.exponent;
    const float shrink = ted4_bits_float((uint32_t)(127 - e) << 23); /* 2^-e */

    for (int c = 0; c < 3; c++)
        job.camera[c] = (q->camera[c] - r->head.origin[c]) * shrink;
    job.t = (float)q->num / (float)q->den;
    job.unit = ted4_bits_float((uint32_t)(127 + e) << 23);
    ted4_recon_set_time(r, q->num, q->den);
    ted4_parallel_for(p, r->n_chunks, do_chunk, &job);
    for (size_t i = 0; i < r->n_chunks; i++)
        worst = r->scratch[i].worst > worst ? r->scratch[i].worst : worst;
    r->last = *q;
    r->fresh = worst < 0x7f800000u; /* R-REC-001: neither infinite nor NaN */
    if (!r->fresh)
        return TED4_E_REC_NONFINITE;
    *g = r->out;
    return TED4_OK;
}
