/* tiles.c - see tiles.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "write/tiles.h"

#include <string.h>
#include "kernel/int_kernel.h"

/* The number of tiles that are walked at once, and the work memory in bytes that they may take
 * together. One tile is always allowed. */
enum { BATCH = 16, BATCH_BYTES = 1 << 28 };

/* Returns the nearest 16-bit probability of a 1, or one half if nothing was counted. */
static uint16_t probability(uint64_t ones, uint64_t n)
{
    const uint64_t p = n > 0 ? (ones * 65536 + n / 2) / n : 32768;

    return (uint16_t)(p < 1 ? 1 : p > 65535 ? 65535 : p);
}

/* Counts, in each context of spec 9.3, the ones and all bits of anchors first .. end - 1. */
static void count_masks(const ted4_scene *s, size_t first, size_t end, uint64_t ones[TED4_PROBS],
                        uint64_t n[TED4_PROBS])
{
    for (size_t a = first; a < end; a++) {
        unsigned seen = 1;

        ones[0] += s->dynamic[a];
        n[0]++;
        for (unsigned k = 0; k < s->head.n_offsets; k++) {
            const unsigned context = 1 + 3u * s->dynamic[a] + seen;
            const unsigned bits = s->offset_bits[a] & ((2u << k) - 1);

            ones[context] += bits >> k & 1;
            n[context]++;
            seen = bits == 0 ? 0 : bits == (2u << k) - 1 ? 1 : 2;
        }
    }
}

static void choose_probabilities(ted4_draft *d, const ted4_scene *s)
{
    const size_t step = s->head.tile_size, n_anchors = s->head.n_anchors;

    for (size_t t = 0; t < s->shape.n_tiles; t++) {
        const size_t first = t * step;
        uint64_t ones[TED4_PROBS] = { 0 }, n[TED4_PROBS] = { 0 };

        count_masks(s, first, n_anchors - first < step ? n_anchors : first + step, ones, n);
        for (int i = 0; i < TED4_PROBS; i++) {
            const uint16_t said = s->prob[t * TED4_PROBS + i];

            d->s.prob[t * TED4_PROBS + i] = said != 0 ? said : probability(ones[i], n[i]);
        }
    }
}

ted4_status ted4_draft_init(ted4_draft *d, const ted4_scene *s)
{
    const ted4_options unbounded = { .max_bytes = UINT64_MAX };
    const ted4_header *h = &s->head;

    memset(d, 0, sizeof *d);
    d->s = *s;
    ted4_arena_init(&d->arena, &unbounded);
    for (size_t a = 0; a < h->n_anchors; a++)
        if (s->dynamic[a] > 1 || s->offset_bits[a] >> h->n_offsets != 0)
            return TED4_E_SYN_HASH;
    d->s.prob = ted4_arena_alloc(&d->arena, s->shape.n_tiles, TED4_PROBS * sizeof *d->s.prob);
    if (d->s.prob == NULL)
        return TED4_E_LIMIT_MEMORY;
    choose_probabilities(d, s);
    if (ted4_prior_init(&d->prior, h, &s->shape, &d->arena) != TED4_OK)
        return TED4_E_LIMIT_MEMORY;
    d->prior.dense = ted4_select_int_dense();
    return TED4_OK;
}

void ted4_draft_finish(ted4_draft *d)
{
    ted4_arena_finish(&d->arena);
}

typedef struct {
    ted4_draft *d;
    char *coders;
    size_t stride, first, work_size;
    char *work; /* [BATCH][work_size] */
} batch;

static void walk_one(void *arg, size_t i)
{
    const batch *b = arg;
    const size_t tile = b->first + i;

    ted4_walk_tile((ted4_coder *)(void *)(b->coders + tile * b->stride), &b->d->s, &b->d->prior,
                   (unsigned)tile, b->work + i * b->work_size);
}

ted4_error ted4_draft_tiles(ted4_draft *d, void *coders, size_t stride, const ted4_parallel *p)
{
    const size_t n_tiles = d->s.shape.n_tiles;
    size_t per_batch = p == NULL ? 1 : n_tiles < BATCH ? n_tiles : BATCH;
    ted4_error e = { TED4_OK, 0 };
    batch b = { .d = d, .coders = coders, .stride = stride };

    b.work_size = (ted4_tile_work_size(&d->s) + 63) / 64 * 64;
    if (per_batch > BATCH_BYTES / b.work_size)
        per_batch = BATCH_BYTES / b.work_size > 0 ? BATCH_BYTES / b.work_size : 1;
    b.work = ted4_arena_alloc(&d->arena, per_batch, b.work_size);
    if (b.work == NULL)
        ted4_fail(&e, TED4_E_LIMIT_MEMORY, 0);
    for (; b.first < n_tiles && e.code == TED4_OK; b.first += per_batch) {
        const size_t left = n_tiles - b.first;

        ted4_parallel_for(p, left < per_batch ? left : per_batch, walk_one, &b);
        for (size_t i = 0; i < left && i < per_batch; i++) {
            const ted4_coder *c =
                (const ted4_coder *)(const void *)(b.coders + (b.first + i) * stride);

            if (c->error.code != TED4_OK)
                ted4_fail(&e, c->error.code, c->error.offset);
        }
    }
    ted4_arena_release(&d->arena, b.work);
    return e;
}
