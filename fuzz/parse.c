/* parse.c - see parse.h. Pass 2 (spec 5.3) on one thread, with the walks of norm/ and the coder of
 * read/. The forgiving coder is the same coder, but it clears failures inside substreams and goes
 * on; what substreams of adaptive bits then give is made legal. SPDX-License-Identifier:
 * BSD-2-Clause */
#include "parse.h"

#include <string.h>
#include "harness.h"
#include "norm/prior.h"
#include "places.h"
#include "read/container.h"
#include "read/inflate.h"
#include "write/snap.h"

typedef struct {
    ted4_scene *s;
    ted4_prior prior;
    ted4_reader file;
    void *work; /* for one tile; allocated in the scene's arena */
    unsigned n_tiles;
    int forgiving;
} parser;

/* Returns the operations of read/reader.c, which all readers share and on which the forgiving ones
 * are built. */
static const ted4_coder_ops *strict_ops(void)
{
    ted4_reader r;

    ted4_reader_init(&r, NULL, 0, 0, 0);
    return r.base.ops;
}

/* Clears a failure of the operation before. Returns 1 if there was one. */
static int forgive(ted4_coder *c)
{
    const int failed = c->error.code != TED4_OK;

    c->error.code = TED4_OK;
    return failed;
}

/* Corrects a number: tile_index gets its only valid value, and a probability is at least 1. */
static uint32_t any_number(ted4_coder *c, unsigned width, uint32_t value)
{
    const uint32_t read = strict_ops()->number(c, width, value);

    return width == 4 ? value : read > 0 ? read : 1;
}

/* Cuts sizes that do not fit. The last substream gets the remaining bytes. */
static void any_sizes(ted4_coder *c, uint32_t *size, unsigned n)
{
    ted4_reader *r = (ted4_reader *)c;
    size_t left;
    const int whole = r->end - c->pos >= 4 * (size_t)n;

    strict_ops()->sizes(c, size, n);
    if (!whole)
        return;
    (void)forgive(c);
    left = r->end - c->pos;
    for (unsigned i = 0; i < n; i++) {
        if (size[i] > left || i + 1 == n)
            size[i] = (uint32_t)left;
        r->size[i] = size[i];
        left -= size[i];
    }
}

/* A substream that cannot begin is treated as one without words. */
static void any_open(ted4_coder *c, size_t n)
{
    ted4_reader *r = (ted4_reader *)c;
    ted4_rans_dec *d = &r->rans;

    if (c->error.code != TED4_OK)
        return;
    strict_ops()->open(c, n);
    if (!forgive(c))
        return;
    memset(d, 0, sizeof *d);
    d->n_lanes = ted4_rans_lanes(n);
    d->word = d->end = r->data + r->end;
    for (unsigned i = 0; i < d->n_lanes; i++)
        d->state[i] = TED4_RANS_LOW;
}

/* The substream takes what there is, however short that is. */
static void any_rest(ted4_coder *c, uint64_t n)
{
    if (c->error.code != TED4_OK)
        return;
    strict_ops()->rest(c, n);
    (void)forgive(c);
}

static void any_close(ted4_coder *c)
{
    (void)c;
}

static int any_bit(ted4_coder *c, uint32_t prob, int value)
{
    const int had_failed = c->error.code != TED4_OK, bit = strict_ops()->bit(c, prob, value);

    if (had_failed)
        return 0;
    ((ted4_reader *)c)->rans.underrun = 0;
    (void)forgive(c);
    return bit;
}

static void any_gauss(ted4_coder *c, size_t n, const int32_t *mu, const uint8_t *sigma, int16_t *k)
{
    ted4_rans_dec *d = &((ted4_reader *)c)->rans;

    for (size_t i = 0; i < n; i++) {
        strict_ops()->gauss(c, 1, mu + i, sigma + i, k + i);
        d->underrun = 0;
        if (forgive(c))
            k[i] = (int16_t)ted4_sat16(ted4_floor_shift(mu[i], TED4_MU_BITS));
        k[i] = k[i] == INT16_MIN ? -INT16_MAX : k[i];
    }
}

/* Makes R-ATT-001 hold in a tile. */
static void order_tau(ted4_scene *s, unsigned number)
{
    const size_t n = s->head.n_anchors, first = (size_t)number * s->head.tile_size;
    int16_t *tau = s->symbol[TED4_TAU];

    for (size_t i = first; tau != NULL && i < n && i - first < s->head.tile_size; i++)
        if (tau[i] > tau[2 * n + i])
            tau[2 * n + i] = tau[i];
}

/* Operations of a reader that forgives what is wrong inside a substream of adaptive bits. */
static const ted4_coder_ops *forgiving_rest(void)
{
    static ted4_coder_ops any;

    any = *strict_ops();
    any.open = any_open;
    any.close = any_close;
    any.bit = any_bit;
    any.rest = any_rest;
    return &any;
}

/* Replaces the values of a blob of mode 2 that R-NET-012 forbids. */
static void settle_values(ted4_reader *r, ted4_blob *b)
{
    if (b->mode != TED4_BLOB_CODED || r->base.error.code != TED4_E_NET_VALUE)
        return;
    (void)forgive(&r->base);
    for (size_t i = 0; i < b->n; i++)
        if (!ted4_float_legal(ted4_float_bits(b->values[i])))
            b->values[i] = 0;
}

/* Replaces the shifts and values of NETE where the rules of 7.3 forbid them. */
static void settle_nete(parser *p, ted4_reader *r)
{
    ted4_scene *s = p->s;
    const ted4_status is = r->base.error.code;

    if (s->nete.mode != TED4_BLOB_CODED ||
        (is != TED4_E_NET_VALUE && is != TED4_E_NET_ACCUMULATOR && is != TED4_E_NET_WEIGHT_RANGE))
        return;
    (void)forgive(&r->base);
    ted4_snap(&s->head, &s->shape, s->nete.values, s->shift);
    if (ted4_prior_load(&p->prior, s->nete.values, s->shift, NULL) != TED4_OK)
        ted4_fail(&r->base.error, TED4_E_NET_VALUE, r->end);
}

/* Replaces positions that R-POS-001 or R-POS-005 forbids. */
static void settle_positions(parser *p, ted4_reader *r)
{
    const ted4_status is = r->base.error.code;

    if (is != TED4_E_POS_COUNT && is != TED4_E_POS_VALUE && is != TED4_E_POS_RANGE)
        return;
    (void)forgive(&r->base);
    if (!fuzz_settle(p->s->position, p->s->head.n_anchors, p->s->grid))
        ted4_fail(&r->base.error, is, r->end);
}

static ted4_reader reader_of(parser *p, const ted4_chunk_place *place)
{
    ted4_reader r;

    ted4_reader_init(&r, p->file.data, place->payload, place->end, 0);
    r.arena = &p->s->arena;
    return r;
}

/* left: payload bytes for mode and values. Memory is allocated only if they can hold the values. */
static int blob(parser *p, ted4_blob *b, uint64_t n, size_t left)
{
    b->n = n;
    if (left == 0 || ((left - 1) / 4 < n && ted4_inflate_impossible(left - 1, n) &&
                      (p->s->profile == TED4_PROFILE_MAIN || left - 1 < ted4_rest_least(n))))
        return 0;
    b->exponent = ted4_arena_alloc(&p->s->arena, n, 1);
    return b->exponent != NULL && ted4_blob_alloc(p->s, b, n);
}

static void nete(parser *p, ted4_reader *r)
{
    ted4_scene *s = p->s;
    const size_t bytes = r->end - r->base.pos, n_shifts = s->shape.n_units;

    if (bytes < n_shifts || !ted4_scene_alloc_shifts(s) ||
        !blob(p, &s->nete, s->shape.n_nete, bytes - n_shifts) ||
        ted4_prior_init(&p->prior, &s->head, &s->shape, &s->arena) != TED4_OK)
        ted4_fail(&r->base.error, TED4_E_LIMIT_MEMORY, r->base.pos);
    else
        ted4_walk_nete(&r->base, s, &p->prior);
    if (p->forgiving)
        settle_nete(p, r);
}

static void values(parser *p, ted4_reader *r, ted4_blob *b, uint64_t n)
{
    if (!blob(p, b, n, r->end - r->base.pos))
        ted4_fail(&r->base.error, TED4_E_LIMIT_MEMORY, r->base.pos);
    else
        ted4_walk_blob(&r->base, "value", p->s, b);
    if (p->forgiving)
        settle_values(r, b);
}

static void positions(parser *p, ted4_reader *r)
{
    const size_t bytes = r->end - r->base.pos;
    const uint32_t n = p->s->head.n_anchors;

    if (p->s->bank.n != p->s->shape.n_bank ||
        (p->s->profile == TED4_PROFILE_MAIN ? bytes / 6 < n : bytes <= ted4_rest_least(n)) ||
        !ted4_scene_alloc_anchors(p->s) ||
        (p->work = ted4_arena_alloc(&p->s->arena, 1, ted4_tile_work_size(p->s))) == NULL) {
        ted4_fail(&r->base.error, TED4_E_LIMIT_MEMORY, r->base.pos);
        return;
    }
    for (size_t i = 0; p->forgiving && i < 3 * (size_t)n; i++)
        p->s->position[i] = FUZZ_NO_PLACE;
    ted4_walk_positions(&r->base, p->s);
    if (p->forgiving && p->s->profile == TED4_PROFILE_COMPACT)
        settle_positions(p, r);
}

static void tile(parser *p, ted4_reader *r)
{
    const ted4_coder_ops any = { any_number, r->base.ops->array, r->base.ops->deflated,
                                 any_sizes,  any_open,           any_close,
                                 any_bit,    any_gauss,          any_rest };

    if (p->work == NULL || p->n_tiles == p->s->shape.n_tiles) {
        ted4_fail(&r->base.error, TED4_E_CON_CHUNK_ORDER, r->base.pos);
        return;
    }
    if (p->forgiving)
        r->base.ops = &any;
    ted4_walk_tile(&r->base, p->s, &p->prior, p->n_tiles, p->work);
    if (p->forgiving && r->base.error.code == TED4_E_ATT_TAU_ORDER)
        (void)forgive(&r->base);
    order_tau(p->s, p->n_tiles++);
}

/* Returns 0 if the chunk is not valid. */
static int chunk(parser *p, const ted4_chunk_place *place)
{
    ted4_scene *s = p->s;
    ted4_reader r = reader_of(p, place);

    if (p->forgiving && s->profile == TED4_PROFILE_COMPACT && place->type != TED4_TILE)
        r.base.ops = forgiving_rest();
    switch (place->type) {
    case TED4_HEAD: ted4_walk_header(&r.base, &s->head, &s->shape, s->level, p->file.end); break;
    case TED4_NETE: nete(p, &r); break;
    case TED4_NETR: values(p, &r, &s->netr, s->shape.n_netr); break;
    case TED4_BANK:
        if (s->shape.n_bank == 0)
            return 0;
        values(p, &r, &s->bank, s->shape.n_bank);
        break;
    case TED4_POSN: positions(p, &r); break;
    case TED4_TILE: tile(p, &r); break;
    default: return 1;
    }
    return r.base.error.code == TED4_OK && r.base.pos == r.end;
}

static int chunks(parser *p, size_t *ends)
{
    ted4_coder *c = &p->file.base;

    c->pos = 0;
    ted4_walk_file_header(c, 0, &p->s->profile, &p->s->level);
    while (c->error.code == TED4_OK && c->pos < p->file.end) {
        const ted4_chunk_place place = ted4_container_next(&p->file);

        if (!chunk(p, &place))
            return 0;
        *ends = place.payload;
    }
    return p->s->prob != NULL && p->n_tiles == p->s->shape.n_tiles;
}

ted4_scene *fuzz_parse(const uint8_t *data, size_t size, int forgiving, size_t *ends)
{
    static const ted4_options o = { .max_bytes = FUZZ_MAX_BYTES };
    parser p;

    memset(&p, 0, sizeof p);
    p.forgiving = forgiving;
    *ends = 0;
    ted4_reader_init(&p.file, data, 0, size, 1);
    ted4_container_check(&p.file);
    if (p.file.base.error.code != TED4_OK || (p.s = ted4_scene_empty(&o)) == NULL)
        return NULL;
    if (chunks(&p, ends)) {
        ted4_scene_hash(p.s, p.s->hash);
        return p.s;
    }
    ted4_scene_free(p.s);
    return NULL;
}
