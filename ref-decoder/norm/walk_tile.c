/* walk_tile.c - spec 9.1, 9.3, 10: one tile of anchors.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "norm/coder.h"

#include <string.h>

#include "norm/prior.h"

enum { BLOCK = TED4_PRIOR_BLOCK,
       MAX_SUBSTREAMS = 1 + TED4_MAX_SLICES + TED4_TYPES - 1 };

/* A walk under way. Arrays lie in the caller's work memory. */
typedef struct {
    ted4_coder       *c;
    ted4_scene       *s;
    const ted4_prior *prior;
    size_t            first, n, n_blocks;   /* anchors of the tile, in blocks of 64 */
    int32_t          *out;      /* [n_blocks][P][64] outputs of the hyperprior */
    int16_t          *ctx;      /* [n_blocks][F][64] what the slice networks see */
    int32_t          *added;    /* [2 max slice][64] outputs of a slice network */
    uint32_t         *index;    /* [n_index] anchors of the tile that have the component */
    size_t            n_index;
    int32_t          *mu;       /* [n] of those anchors, as sigma and k */
    int16_t          *k;
    uint8_t          *sigma;
    size_t            opened;   /* offset of the first byte of the open substream */
} tile;

static const char *const type_name[TED4_TYPES] = {
    "feature", "scaling", "offset", "phi", "tau"
};
static const char *const substream_name[TED4_TYPES] = {
    "feature_substream", "scaling_substream", "offset_substream",
    "phi_substream", "tau_substream"
};

static size_t block_count(size_t n)
{
    return (n + BLOCK - 1) / BLOCK;
}

static size_t tile_anchors(const ted4_header *h)
{
    return h->tile_size < h->n_anchors ? h->tile_size : h->n_anchors;
}

size_t ted4_tile_work_size(const ted4_scene *s)
{
    const size_t n = block_count(tile_anchors(&s->head)) * BLOCK;
    const size_t per_anchor = 4 * (size_t)s->shape.n_outputs
                            + 2 * (size_t)s->head.feature_dim + 4 + 4 + 2 + 1;
    const size_t fixed = sizeof(int32_t) * 2 * TED4_MAX_FEATURE * BLOCK;

    if (n > (SIZE_MAX - fixed) / per_anchor)
        return SIZE_MAX;
    return n * per_anchor + fixed;
}

/* Every array is a multiple of 64 bytes long, as n is one of 64. */
static void carve(tile *t, void *work)
{
    const size_t n = t->n_blocks * BLOCK;
    char        *at = work;

    t->out = (int32_t *)(void *)at;
    at += 4 * n * t->s->shape.n_outputs;
    t->added = (int32_t *)(void *)at;
    at += sizeof(int32_t) * 2 * TED4_MAX_FEATURE * BLOCK;
    t->index = (uint32_t *)(void *)at;
    at += 4 * n;
    t->mu = (int32_t *)(void *)at;
    at += 4 * n;
    t->ctx = (int16_t *)(void *)at;
    at += 2 * n * t->s->head.feature_dim;
    t->k = (int16_t *)(void *)at;
    at += 2 * n;
    t->sigma = (uint8_t *)at;
}

static uint16_t probability(ted4_coder *c, const char *name, int64_t index,
                            uint16_t value)
{
    const size_t at = c->pos;

    value = (uint16_t)ted4_code(c, name, index, 2, value);
    ted4_require(c, value > 0, TED4_E_ENT_PROB, at);
    return value;
}

/* spec 9.1, all but the substreams */
static void walk_head(tile *t, unsigned number)
{
    ted4_coder *c = t->c;
    uint16_t   *prob = t->s->prob + (size_t)number * TED4_PROBS;
    uint32_t    size[MAX_SUBSTREAMS];
    size_t      at = c->pos;

    ted4_require(c, ted4_code(c, "tile_index", 0, 4, number) == number,
                 TED4_E_ENT_TILE_INDEX, at);
    if (t->s->head.temporal_mask)
        prob[0] = probability(c, "dynamic_prob", 0, prob[0]);
    for (int i = 0; t->s->head.offset_mask && i < 6; i++)
        prob[1 + i] = probability(c, "offset_prob", i, prob[1 + i]);
    at = c->pos;
    c->ops->sizes(c, size, t->s->shape.n_substreams);
    for (unsigned i = 0; c->trace != NULL && i < t->s->shape.n_substreams; i++)
        if (c->error.code == TED4_OK)
            ted4_trace(c, at + 4 * i, "size", i, size[i]);
}

static void open_substream(tile *t, const char *name, unsigned index, size_t n)
{
    t->opened = t->c->pos;
    t->c->ops->open(t->c, n);
    ted4_trace(t->c, t->opened, name, index, (int64_t)n);
}

static void close_substream(tile *t)
{
    t->c->ops->close(t->c);
}

/* What a mask is that is not coded; a scene to be written must agree, or its hash could not. */
static void imply(tile *t, size_t a, int dynamic_too, int offsets_too)
{
    ted4_scene    *s = t->s;
    const uint8_t  dynamic = s->head.motion != TED4_MOTION_NONE;
    const uint16_t all = (uint16_t)((1u << s->head.n_offsets) - 1);

    if (t->c->reads) {
        if (dynamic_too)
            s->dynamic[a] = dynamic;
        if (offsets_too)
            s->offset_bits[a] = all;
        return;
    }
    ted4_require(t->c, (dynamic_too ? s->dynamic[a] == dynamic
                                    : s->dynamic[a] <= 1)
                 && (offsets_too ? s->offset_bits[a] == all
                                 : s->offset_bits[a] <= all),
                 TED4_E_SYN_HASH, t->opened);
}

/* spec 9.3, the offset bits of an anchor. seen: 0 all bits so far 0, 1 all 1 or none yet, 2 mixed. */
static void walk_offset_bits(tile *t, size_t a, const uint16_t *prob)
{
    ted4_scene    *s = t->s;
    const unsigned k_max = s->head.n_offsets, given = s->offset_bits[a];
    unsigned       bits = 0, seen = 1;

    for (unsigned k = 0; k < k_max; k++) {
        const int bit = t->c->ops->bit(t->c, prob[3 * s->dynamic[a] + seen],
                                       given >> k & 1);

        ted4_trace(t->c, t->opened, "offset_bit", (int64_t)(a * k_max + k),
                   bit);
        bits |= (unsigned)bit << k;
        seen = bits == 0 ? 0 : bits == (2u << k) - 1 ? 1 : 2;
    }
    if (t->c->reads)
        s->offset_bits[a] = (uint16_t)bits;
}

/* spec 9.3 */
static void walk_masks(tile *t, const uint16_t *prob)
{
    ted4_scene *s = t->s;
    const int   temporal = s->head.temporal_mask, offset = s->head.offset_mask;

    if (temporal || offset)
        open_substream(t, "mask_substream", 0,
                       t->n * ((temporal ? 1u : 0u)
                               + (offset ? s->head.n_offsets : 0u)));
    for (size_t a = t->first; a < t->first + t->n; a++) {
        imply(t, a, !temporal, !offset);
        if (t->c->error.code != TED4_OK)
            return;
        if (temporal) {
            const int bit = t->c->ops->bit(t->c, prob[0], s->dynamic[a]);

            ted4_trace(t->c, t->opened, "dynamic", (int64_t)a, bit);
            if (t->c->reads)
                s->dynamic[a] = (uint8_t)bit;
        }
        if (offset)
            walk_offset_bits(t, a, prob + 1);
    }
    if (temporal || offset)
        close_substream(t);
}

/* spec 10.1: outputs for the whole tile, and step indices. A scene to be written already has those. */
static void evaluate(tile *t)
{
    const ted4_shape *shape = &t->s->shape;

    for (size_t b = 0; b < t->n_blocks; b++) {
        const size_t a = t->first + b * BLOCK;
        const size_t left = t->first + t->n - a;
        const size_t n = left < BLOCK ? left : BLOCK;
        int32_t     *out = t->out + b * shape->n_outputs * BLOCK;
        const int32_t *v = out + (size_t)shape->first_step_output * BLOCK;

        ted4_prior_hyper(t->prior, t->s->position + 3 * a, n, out);
        for (int type = 0; type < TED4_TYPES; type++) {
            uint8_t *step = t->s->step_index[type];

            if (shape->dim[type] == 0)
                continue;
            for (size_t i = 0; i < n; i++) {
                const uint8_t index = ted4_step_index(v[i]);

                if (t->c->reads)
                    step[a + i] = index;
                ted4_require(t->c, step[a + i] == index, TED4_E_SYN_HASH,
                             t->c->pos);
            }
            v += BLOCK;
        }
    }
}

/* The anchors that have a component: all of them; those that move; those that keep an offset. */
static void choose_all(tile *t)
{
    t->n_index = t->n;
    for (size_t i = 0; i < t->n; i++)
        t->index[i] = (uint32_t)i;
}

static void choose_dynamic(tile *t)
{
    t->n_index = 0;
    for (size_t i = 0; i < t->n; i++) {
        t->index[t->n_index] = (uint32_t)i;
        t->n_index += t->s->dynamic[t->first + i];
    }
}

static void choose_offset(tile *t, unsigned k)
{
    t->n_index = 0;
    for (size_t i = 0; i < t->n; i++) {
        t->index[t->n_index] = (uint32_t)i;
        t->n_index += t->s->offset_bits[t->first + i] >> k & 1;
    }
}

/* Models of the chosen anchors, from outputs of the hyperprior: mu and s of a component, of the tile's first block. */
static void choose_models(tile *t, const int32_t *mu, const int32_t *s)
{
    const size_t per_block = (size_t)t->s->shape.n_outputs * BLOCK;

    if (t->n_index == t->n) {       /* side by side, a block at a time */
        for (size_t b = 0; b < t->n; b += BLOCK, mu += per_block, s += per_block) {
            const size_t n = t->n - b < BLOCK ? t->n - b : BLOCK;

            memcpy(t->mu + b, mu, n * sizeof *mu);
            for (size_t i = 0; i < n; i++)
                t->sigma[b + i] = ted4_sigma_index(s[i]);
        }
        return;
    }
    for (size_t i = 0; i < t->n_index; i++) {
        const size_t a = t->index[i], from = a / BLOCK * per_block + a % BLOCK;

        t->mu[i] = mu[from];
        t->sigma[i] = ted4_sigma_index(s[from]);
    }
}

/* spec 10.2: component number comp of a type, for the chosen anchors. */
static void walk_component(tile *t, ted4_type type, unsigned comp)
{
    const ted4_shape *shape = &t->s->shape;
    const int32_t *mu = t->out + (shape->first_output[type] + comp) * BLOCK;
    const size_t   row = (size_t)comp * t->s->head.n_anchors + t->first;
    int16_t       *symbol = t->s->symbol[type] + row;
    const int      whole = t->n_index == t->n;
    int16_t       *k = whole ? symbol : t->k;

    if (t->c->error.code != TED4_OK)
        return;
    choose_models(t, mu, mu + (size_t)shape->dim[type] * BLOCK);
    for (size_t i = 0; !whole && !t->c->reads && i < t->n_index; i++)
        k[i] = symbol[t->index[i]];
    t->c->ops->gauss(t->c, t->n_index, t->mu, t->sigma, k);
    for (size_t i = 0; !whole && t->c->reads && i < t->n_index; i++)
        symbol[t->index[i]] = k[i];
    for (size_t i = 0; t->c->reads && t->c->trace != NULL && i < t->n_index; i++)
        ted4_trace(t->c, t->opened, type_name[type], (int64_t)(row + t->index[i]), k[i]);
}

/* spec 10.3: contexts of one feature component, for the slices that follow. */
static void keep_context(tile *t, unsigned comp)
{
    const ted4_scene *s = t->s;
    const int16_t *k = s->symbol[TED4_FEATURE]
                     + (size_t)comp * s->head.n_anchors + t->first;
    const uint8_t *step = s->step_index[TED4_FEATURE] + t->first;

    for (size_t i = 0; i < t->n_blocks * BLOCK; i++) {
        int16_t *x = t->ctx + (i / BLOCK * s->head.feature_dim + comp) * BLOCK;

        x[i % BLOCK] = i < t->n ? ted4_context(k[i], step[i],
                                               s->head.context_bits) : 0;
    }
}

/* spec 10.3: what the slice network says, onto mu and s of its slice, which begins at component comp. */
static void add_slice(tile *t, unsigned m, unsigned comp)
{
    const ted4_shape *shape = &t->s->shape;
    const unsigned    dim = t->s->head.slice[m];

    for (size_t b = 0; b < t->n_blocks; b++) {
        const size_t left = t->n - b * BLOCK, n = left < BLOCK ? left : BLOCK;
        int32_t *out = t->out + b * shape->n_outputs * BLOCK;
        int32_t *mu = out + (shape->first_output[TED4_FEATURE] + comp) * BLOCK;
        int32_t *s = mu + (size_t)shape->dim[TED4_FEATURE] * BLOCK;
        const int32_t *more = t->added;

        ted4_prior_slice(t->prior, m,
                         t->ctx + b * t->s->head.feature_dim * BLOCK, n,
                         t->added);
        for (unsigned c = 0; c < dim; c++, mu += BLOCK, more += BLOCK)
            for (size_t i = 0; i < n; i++)
                mu[i] += more[i];
        for (unsigned c = 0; c < dim; c++, s += BLOCK, more += BLOCK)
            for (size_t i = 0; i < n; i++)
                s[i] += more[i];
    }
}

/* spec 9.1, 10.3 */
static void walk_feature(tile *t)
{
    const ted4_header *h = &t->s->head;
    unsigned comp = 0;

    choose_all(t);
    for (unsigned m = 0; m < h->n_slices; m++) {
        if (m > 0)
            add_slice(t, m, comp);
        open_substream(t, substream_name[TED4_FEATURE], m,
                       t->n * h->slice[m]);
        for (unsigned i = 0; i < h->slice[m]; i++, comp++) {
            walk_component(t, TED4_FEATURE, comp);
            if (t->c->error.code != TED4_OK)
                return;
            if (m + 1 < h->n_slices)
                keep_context(t, comp);
        }
        close_substream(t);
    }
}

/* A type whose components all have the chosen anchors. */
static void walk_type(tile *t, ted4_type type)
{
    const unsigned dim = t->s->shape.dim[type];

    if (dim == 0)
        return;
    open_substream(t, substream_name[type], 0, t->n_index * dim);
    for (unsigned i = 0; i < dim; i++)
        walk_component(t, type, i);
    close_substream(t);
}

static void walk_offsets(tile *t)
{
    const unsigned k_max = t->s->head.n_offsets;
    size_t         n = 0;

    for (unsigned k = 0; k < k_max; k++) {
        choose_offset(t, k);
        n += 3 * t->n_index;
    }
    open_substream(t, substream_name[TED4_OFFSET], 0, n);
    for (unsigned k = 0; k < k_max; k++) {
        choose_offset(t, k);
        for (unsigned j = 0; j < 3; j++)
            walk_component(t, TED4_OFFSET, 3 * k + j);
    }
    close_substream(t);
}

/* R-ATT-001 */
static void judge_tau(tile *t)
{
    const size_t   n = t->s->head.n_anchors;
    const int16_t *start, *end;

    if (t->s->shape.dim[TED4_TAU] == 0 || t->c->error.code != TED4_OK)
        return;
    start = t->s->symbol[TED4_TAU] + t->first;
    end = start + 2 * n;
    for (size_t i = 0; i < t->n; i++)
        ted4_require(t->c, start[i] <= end[i], TED4_E_ATT_TAU_ORDER,
                     t->opened);
}

/* spec 9.1 */
void ted4_walk_tile(ted4_coder *c, ted4_scene *s, const ted4_prior *prior,
                    unsigned number, void *work)
{
    tile t = { .c = c, .s = s, .prior = prior };

    t.first = (size_t)number * s->head.tile_size;
    t.n = s->head.n_anchors - t.first;
    if (t.n > s->head.tile_size)
        t.n = s->head.tile_size;
    t.n_blocks = block_count(t.n);
    carve(&t, work);
    walk_head(&t, number);
    walk_masks(&t, s->prob + (size_t)number * TED4_PROBS);
    if (c->error.code != TED4_OK)
        return;
    evaluate(&t);
    walk_feature(&t);
    choose_all(&t);
    walk_type(&t, TED4_SCALING);
    walk_offsets(&t);
    choose_dynamic(&t);
    walk_type(&t, TED4_PHI);
    choose_all(&t);
    walk_type(&t, TED4_TAU);
    judge_tau(&t);
}
