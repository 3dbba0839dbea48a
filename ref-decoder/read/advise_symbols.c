/* advise_symbols.c - reports what is doubtful in the coded symbols of a valid file: probabilities,
 * escapes, and indices and contexts at the ends of their ranges. It walks the tiles once more with
 * a coder that only counts.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "read/advise_parts.h"

#include <string.h>
#include "norm/gaussian.h"
#include "norm/scene.h"
#include "read/observe.h"

/* An escape or a sigma at an end of the table is reported if more than 1 of ESCAPES_ONE_OF or
 * SIGMA_ONE_OF symbols is one, and if there are at least FEW symbols. A probability is reported if
 * it differs by more than PROB_FAR / 65536 from the frequency. */
enum { ESCAPES_ONE_OF = 256, SIGMA_ONE_OF = 64, FEW = 256, PROB_FAR = 2048 };

typedef struct {
    uint64_t symbols, escapes, sigma_ends;
} type_counts;

/* The walk is given the probabilities 1 to TED4_PROBS instead of those of the tile, so that the
 * probability of a bit says in which element (prob - 1) of bits and ones it is counted. */
typedef struct {
    ted4_coder base; /* must be first */
    int type;        /* parameter type of the open substream */
    type_counts count[TED4_TYPES];
    uint64_t bits[TED4_PROBS], ones[TED4_PROBS]; /* of the tile */
} census;

static int bit(ted4_coder *c, uint32_t prob, int value)
{
    census *n = (census *)c;

    n->bits[prob - 1]++;
    n->ones[prob - 1] += (unsigned)value;
    return value;
}

static void gauss(ted4_coder *c, size_t n, const int32_t *mu, const uint8_t *sigma, int16_t *k)
{
    census *all = (census *)c;
    type_counts *t = &all->count[all->type];

    t->symbols += n;
    for (size_t i = 0; i < n; i++) {
        t->escapes += ted4_gauss_of(mu[i], sigma[i], k[i]).escape >= 0;
        t->sigma_ends += sigma[i] == 0 || sigma[i] == TED4_N_SIGMA - 1;
    }
}

static const char *const type_name[TED4_TYPES] = { "feature", "scaling", "offset", "phi", "tau" };

/* Sets the type of the open substream: the walk traces its name when it opens it. */
static void follow(void *user, size_t offset, const char *element, int64_t index, int64_t value)
{
    census *n = user;

    (void)offset;
    (void)index;
    (void)value;
    for (int t = 0; t < TED4_TYPES; t++)
        if (strncmp(element, type_name[t], strlen(type_name[t])) == 0 &&
            strcmp(element + strlen(type_name[t]), "_substream") == 0)
            n->type = t;
}

/* Checks R-ENC-006 for the probabilities of the tile at offset at. */
static void advise_probs(ted4_findings *f, const census *n, const uint16_t *prob, size_t at)
{
    for (int i = 0; i < TED4_PROBS; i++) {
        const uint64_t ones = n->ones[i], bits = n->bits[i];
        const int64_t best = bits > 0 ? (int64_t)((ones * 65536 + bits / 2) / bits) : prob[i];
        const uint64_t dear = prob[i] == 1 ? ones : prob[i] == 65535 ? bits - ones : 0;

        if (prob[i] - best > PROB_FAR || best - prob[i] > PROB_FAR)
            ted4_find_advice(f, TED4_ADV_PROB, "TILE", at, 2, prob[i], best);
        if (dear > 0)
            ted4_find_advice(f, TED4_ADV_PROB_EXTREME, "TILE", at, 2, prob[i], (int64_t)dear);
    }
}

static void advise_counts(ted4_findings *f, const census *n, size_t at)
{
    for (int t = 0; t < TED4_TYPES; t++) {
        const type_counts *c = &n->count[t];

        if (c->symbols >= FEW && c->escapes * ESCAPES_ONE_OF > c->symbols)
            ted4_find_advice(f, TED4_ADV_ESCAPES, type_name[t], at, 2, (int64_t)c->escapes,
                             (int64_t)c->symbols);
        if (c->symbols >= FEW && c->sigma_ends * SIGMA_ONE_OF > c->symbols)
            ted4_find_advice(f, TED4_ADV_SIGMA, type_name[t], at, 2, (int64_t)c->sigma_ends,
                             (int64_t)c->symbols);
    }
}

static void advise_steps(ted4_findings *f, const ted4_scene *s, size_t at)
{
    for (int t = 0; t < TED4_TYPES; t++) {
        int64_t ends = 0;

        for (size_t i = 0; s->shape.dim[t] > 0 && i < s->head.n_anchors; i++)
            ends += s->step_index[t][i] == 0 || s->step_index[t][i] == 255;
        if (ends > 0)
            ted4_find_advice(f, TED4_ADV_STEP, type_name[t], at, 2, ends, s->head.n_anchors);
    }
}

/* Checks the contexts of spec 10.3 that slices read, that is, those of all slices but the last. */
static void advise_contexts(ted4_findings *f, const ted4_scene *s, size_t at)
{
    const ted4_header *h = &s->head;
    const size_t n = h->n_anchors;
    const unsigned seen = h->feature_dim - h->slice[h->n_slices - 1u];
    int64_t ends = 0;

    for (size_t c = 0; c < seen; c++)
        for (size_t i = 0; i < n; i++) {
            const int16_t x = ted4_context(s->symbol[TED4_FEATURE][c * n + i],
                                           s->step_index[TED4_FEATURE][i], h->context_bits);

            ends += x == 32767 || x == -32767;
        }
    if (ends > 0)
        ted4_find_advice(f, TED4_ADV_CONTEXT, "feature", at, 2, ends, (int64_t)(seen * n));
}

/* Counts the symbols of all tiles, and checks the probabilities of each tile. *first_at is set to
 * the offset of the first tile. */
static void walk_tiles(ted4_findings *f, const ted4_scene *given, census *n, ted4_observation *it,
                       size_t *first_at)
{
    ted4_reader r;
    unsigned tile = 0;

    ted4_reader_init(&r, f->data, TED4_FILE_HEADER_SIZE, f->size, 1);
    while (r.base.pos < f->size) {
        const ted4_chunk_place p = ted4_container_next(&r);
        const uint16_t *prob = given->prob + (size_t)tile * TED4_PROBS;

        if (p.type != TED4_TILE)
            continue;
        if (tile == 0)
            *first_at = p.at;
        memset(n->bits, 0, sizeof n->bits);
        memset(n->ones, 0, sizeof n->ones);
        ted4_walk_tile(&n->base, &it->scene, &it->prior, tile++, it->work);
        advise_probs(f, n, prob, p.at);
    }
}

/* Replaces the probabilities of the scene by their numbers; see census. */
static ted4_status number_probs(ted4_observation *it)
{
    const size_t n = (size_t)it->scene.shape.n_tiles * TED4_PROBS;

    it->scene.prob = ted4_arena_alloc(&it->arena, n, sizeof *it->scene.prob);
    if (it->scene.prob == NULL)
        return TED4_E_LIMIT_MEMORY;
    for (size_t i = 0; i < n; i++)
        it->scene.prob[i] = (uint16_t)(1 + i % TED4_PROBS);
    return TED4_OK;
}

void ted4_advise_symbols(ted4_findings *f, const ted4_scene *given, const ted4_options *o)
{
    ted4_coder_ops ops = ted4_observe_ops;
    ted4_observation it;
    ted4_status verdict = ted4_observe_init(&it, given, o);
    census n;
    size_t at = 0;

    memset(&n, 0, sizeof n);
    ops.bit = bit;
    ops.gauss = gauss;
    n.base.ops = &ops;
    n.base.trace = follow;
    n.base.trace_user = &n;
    if (verdict == TED4_OK)
        verdict = number_probs(&it);
    if (verdict == TED4_OK) {
        walk_tiles(f, given, &n, &it, &at);
        advise_counts(f, &n, at);
        advise_steps(f, given, at);
        advise_contexts(f, given, at);
    } else {
        f->starved = 1;
    }
    ted4_observe_finish(&it);
}
