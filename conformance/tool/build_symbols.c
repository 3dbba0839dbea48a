/* build_symbols.c - chooses the symbols of a scene relative to the model that will code them
 * (spec 9.4): r = k - m is the distance from mu.
 *     symbols TYPE|* near                  the default: bell-shaped within the window
 *     symbols TYPE|* edges                 in turn: low escape, both ends of the window and their
 *                                          neighbours, the middle, high escape
 *     symbols TYPE|* sweep                 all values of the window in order, repeated
 *     symbols TYPE|* wild                  one in eight is an escape of any length
 *     symbols TYPE|* escape B [low|high]   e has B bits after the first: 2^B - 1 <= e and
 *                                          e < 2^(B+1) - 1; the sides alternate if none is given
 *     symbols TYPE|* value K ...           these k in turn
 *     symbols TYPE|* r R ...               these r in turn
 *     symbol TYPE COMP ANCHOR K            one k, set after all other lines
 * SPDX-License-Identifier: BSD-2-Clause */
#include <stdlib.h>
#include <string.h>
#include "build.h"
#include "norm/gaussian.h"
#include "norm/prior.h"

enum { BLOCK = TED4_PRIOR_BLOCK };

typedef struct {
    conf_build *b;
    const conf_line *mode[TED4_TYPES]; /* NULL: near */
    ted4_prior prior;
    int32_t *out, *added; /* [P][64], [2 F][64] */
    int16_t *ctx;         /* [F][64] */
    size_t first, n;      /* anchors of the block */
} drawer;

static int legal(int32_t k)
{
    return k >= -32767 && k <= 32767;
}

/* Returns the residual r of an escape of e, on a side for which k is legal. */
static int32_t escape(int32_t m, int32_t hw, int32_t e, int high)
{
    const int32_t low_r = -hw - 1 - e, high_r = hw + 2 + e;

    if (legal(m + (high ? high_r : low_r)))
        return high ? high_r : low_r;
    return high ? low_r : high_r;
}

static int32_t drawn_escape(conf_chance *c, int32_t m, int32_t hw, int bits, int high)
{
    const int32_t least = (1 << bits) - 1;

    for (int32_t e = least + conf_in(c, 0, least);; e = least + (e - least) / 2) {
        const int32_t r = escape(m, hw, e, high);

        if (legal(m + r) || e == least)
            return r;
    }
}

/* Returns the legal k closest to a window that is itself out of range. */
static int32_t clip(int32_t k)
{
    return ted4_clamp(k, -32767, 32767);
}

static int32_t draw(drawer *d, int type, size_t turn, int32_t mu, unsigned g)
{
    conf_chance *c = &d->b->chance;
    const conf_line *l = d->mode[type];
    const int32_t hw = ted4_half[g], m = ted4_floor_shift(mu, TED4_MU_BITS);
    const int32_t edge[8] = { -hw - 1, -hw, 1 - hw, 0, 1, hw, hw + 1, hw + 2 };

    if (l == NULL || conf_word_is(l, 2, "near"))
        return clip(m + ted4_clamp(conf_bell(c, hw), -hw, hw + 1));
    if (conf_word_is(l, 2, "edges"))
        return clip(m + edge[turn % 8]);
    if (conf_word_is(l, 2, "sweep"))
        return clip(m - hw + (int32_t)(turn % (size_t)(2 * hw + 2)));
    if (conf_word_is(l, 2, "wild") && conf_in(c, 0, 7) > 0)
        return clip(m + ted4_clamp(conf_bell(c, hw), -hw, hw + 1));
    if (conf_word_is(l, 2, "wild")) {
        const int high = conf_in(
            c, 0, 1); /* drawn before bits, so that the order does not depend on the compiler */

        return clip(m + drawn_escape(c, m, hw, conf_in(c, 0, 14), high));
    }
    if (conf_word_is(l, 2, "escape")) {
        const int bits = (int)conf_line_number(l, 3, 0, 19);

        return clip(m + drawn_escape(c, m, hw, bits,
                                     l->n > 4 ? conf_word_is(l, 4, "high") : (int)(turn % 2)));
    }
    if (l->n < 4)
        conf_line_bad(l, "no such way, or no value");

    const int32_t v =
        (int32_t)conf_line_number(l, 3 + (int)(turn % (size_t)(l->n - 3)), -(1 << 20), 1 << 20);

    return conf_word_is(l, 2, "value") ? v : clip(m + v);
}

/* Draws the symbols of one component for the anchors of the block. */
static void component(drawer *d, int type, unsigned comp, const int32_t *mu, const int32_t *s)
{
    ted4_scene *scene = d->b->scene;
    const size_t n = scene->head.n_anchors;
    int16_t *k = scene->symbol[type] + comp * n;

    for (size_t i = 0; i < d->n; i++) {
        const size_t a = d->first + i;

        k[a] = (int16_t)draw(d, type, comp * n + a, mu[i], ted4_sigma_index(s[i]));
    }
    for (size_t i = 0; i < d->b->recipe->n; i++) {
        const conf_line *const l = &d->b->recipe->line[i];

        if (!conf_word_is(l, 0, "symbol") || conf_word_type(l, 1) != type ||
            conf_line_number(l, 2, 0, 1000) != comp)
            continue;

        const size_t a = (size_t)conf_line_number(l, 3, 0, (long long)n - 1);

        if (a >= d->first && a < d->first + d->n)
            k[a] = (int16_t)conf_line_number(l, 4, -32767, 32767);
    }
}

/* spec 10.3 */
static void feature(drawer *d)
{
    ted4_scene *s = d->b->scene;
    const unsigned F = s->head.feature_dim;
    unsigned comp = 0;

    for (unsigned m = 0; m < s->head.n_slices; m++) {
        const unsigned dim = s->head.slice[m];

        if (m > 0)
            ted4_prior_slice(&d->prior, m, d->ctx, d->n, d->added);
        for (unsigned c = 0; c < dim; c++, comp++) {
            int32_t *mu = d->out + BLOCK * (size_t)comp, *g = mu + BLOCK * (size_t)F;

            for (size_t i = 0; m > 0 && i < d->n; i++) {
                mu[i] += d->added[BLOCK * c + i];
                g[i] += d->added[BLOCK * (dim + c) + i];
            }
            component(d, TED4_FEATURE, comp, mu, g);
            for (size_t i = 0; i < d->n; i++)
                d->ctx[BLOCK * comp + i] = ted4_context(
                    s->symbol[TED4_FEATURE][comp * (size_t)s->head.n_anchors + d->first + i],
                    s->step_index[TED4_FEATURE][d->first + i], d->prior.context_bits);
        }
    }
}

/* Sets masked symbols to 0, as a decoder does, and makes a_s <= a_f true. */
static void tidy(ted4_scene *s)
{
    const size_t n = s->head.n_anchors;

    for (size_t i = 0; i < n; i++) {
        for (unsigned c = 0; c < s->shape.dim[TED4_OFFSET]; c++)
            if (!(s->offset_bits[i] >> c / 3 & 1))
                s->symbol[TED4_OFFSET][c * n + i] = 0;
        for (unsigned c = 0; c < s->shape.dim[TED4_PHI]; c++)
            if (!s->dynamic[i])
                s->symbol[TED4_PHI][c * n + i] = 0;
        if (s->shape.dim[TED4_TAU] > 0) {
            int16_t *start = s->symbol[TED4_TAU] + i;

            if (start[0] > start[2 * n])
                start[2 * n] = start[0];
        }
    }
}

static void find_modes(drawer *d)
{
    for (size_t i = 0; i < d->b->recipe->n; i++) {
        const conf_line *const l = &d->b->recipe->line[i];

        for (int t = 0; conf_word_is(l, 0, "symbols") && t < TED4_TYPES; t++)
            if (conf_word_is(l, 1, "*") || conf_word_type(l, 1) == t)
                d->mode[t] = l;
    }
}

static void block(drawer *d)
{
    const ted4_shape *sh = &d->b->scene->shape;

    ted4_prior_hyper(&d->prior, d->b->scene->position + 3 * d->first, d->n, d->out);
    feature(d);
    for (int t = TED4_SCALING; t < TED4_TYPES; t++)
        for (unsigned c = 0; c < sh->dim[t]; c++)
            component(d, t, c, d->out + BLOCK * (size_t)(sh->first_output[t] + c),
                      d->out + BLOCK * (size_t)(sh->first_output[t] + sh->dim[t] + c));
}

void conf_build_symbols(conf_build *b)
{
    ted4_scene *s = b->scene;
    const size_t n = s->head.n_anchors;
    ted4_arena arena;
    drawer d = { .b = b };

    ted4_arena_init(&arena, NULL);
    find_modes(&d);
    if (ted4_prior_init(&d.prior, &b->head, &s->shape, &arena) != TED4_OK ||
        ted4_prior_load(&d.prior, s->nete.values, s->shift, NULL) != TED4_OK)
        conf_die("%s: networks", b->recipe->id);
    d.out = conf_alloc((size_t)s->shape.n_outputs, BLOCK * sizeof *d.out);
    d.added = conf_alloc(2 * (size_t)b->head.feature_dim, BLOCK * sizeof *d.added);
    d.ctx = conf_alloc(b->head.feature_dim, BLOCK * sizeof *d.ctx);
    for (d.first = 0; d.first < n; d.first += BLOCK) {
        d.n = n - d.first < BLOCK ? n - d.first : BLOCK;
        block(&d);
    }
    tidy(s);
    free(d.out);
    free(d.added);
    free(d.ctx);
    ted4_arena_finish(&arena);
}
