/* compact_mixing.c - see compact.h. A symbol becomes binary decisions: whether it is the rounded
 * mean, on which side of it, and then whether it is at each distance. The integer model gives the
 * probability of each decision; adaptive probabilities give others.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <stdlib.h>
#include <string.h>
#include "compact.h"
#include "compact_mix.h"

/* Decisions: 0 equal, 1 side, 2 .. distances; beyond the last the integer model is alone. */
enum { DECISIONS = 10, WIDTHS = 16, RATIOS = 6, PLACES = 8, MOST_COMPONENTS = 128 };

typedef struct {
    compact_mixer mixer[DECISIONS][WIDTHS];
    ted4_adaptive component[MOST_COMPONENTS][DECISIONS][WIDTHS / 4];
    ted4_adaptive width[DECISIONS][WIDTHS][PLACES];
    ted4_adaptive near[DECISIONS][WIDTHS][RATIOS][PLACES];
    ted4_adaptive lean[DECISIONS][WIDTHS / 2][PLACES][PLACES];
} contexts;

/* What decides the contexts of one symbol. */
typedef struct {
    unsigned comp, width, ratio, place, lean;
    int any; /* 0: no neighbour */
    double mu, sigma;
    int32_t k, middle;
} symbol;

static unsigned limit(double x, unsigned n)
{
    return x < 0 ? 0 : x >= n ? n - 1 : (unsigned)x;
}

static symbol describe(const compact_models *m, const int32_t *near, int type, unsigned comp,
                       size_t a)
{
    const size_t at = (size_t)comp * m->n + a;
    double mean = 0, magnitude = 0;
    symbol x = { .comp = comp, .k = m->s->symbol[type][at] };

    x.mu = m->mu[type][at] / 256.0;
    x.sigma = compact_sigma(m->sigma[type][at]);
    x.middle = (int32_t)rint(x.mu);
    x.width = limit((m->sigma[type][at] - 32) / 6.0, WIDTHS);
    x.place = limit((x.mu - x.middle + 0.5) * PLACES, PLACES);
    if (near != NULL)
        x.any = compact_missed(m, near, type, comp, a, &mean, &magnitude) > 0;
    x.ratio = x.any ? 1 + limit(2.5 + log2((magnitude + 0.1) / (0.8 * x.sigma + 0.1)), RATIOS - 1)
                    : 0;
    x.lean = limit((mean + x.mu - x.middle) / x.sigma * 2 + PLACES / 2.0, PLACES);
    return x;
}

static double decide(contexts *c, const symbol *x, unsigned decision, double given, int value)
{
    compact_inputs in = { .given = fmin(fmax(given, 1e-4), 1 - 1e-4) };

    in.context[in.n++] = &c->component[x->comp][decision][x->width / 4];
    in.context[in.n++] = &c->width[decision][x->width][x->place];
    if (x->any) {
        in.context[in.n++] = &c->near[decision][x->width][x->ratio][x->place];
        in.context[in.n++] = &c->lean[decision][x->width / 2][x->lean][x->place];
    }
    return compact_mix(&c->mixer[decision][x->width], &in, value);
}

/* The probability under the integer model of all symbols from k on, away from the middle. */
static double beyond(const symbol *x, int32_t k, int side)
{
    return fmax(0.5 * erfc((side * (k - x->mu) - 0.5) / x->sigma * 0.70710678118654752440), 1e-9);
}

static double symbol_bits(contexts *c, const symbol *x)
{
    const double equal = compact_mass(x->middle, x->mu, x->sigma);
    const int side = x->k > x->middle ? 1 : -1;
    const double up = beyond(x, x->middle + 1, 1), down = beyond(x, x->middle - 1, -1);
    double bits = decide(c, x, 0, equal, x->k == x->middle);
    int32_t k = x->middle + side;

    if (x->k == x->middle)
        return bits;
    bits += decide(c, x, 1, up / (up + down), side > 0);
    for (unsigned i = 2; i < DECISIONS; i++, k += side) {
        const double here = compact_mass(k, x->mu, x->sigma) / beyond(x, k, side);

        bits += decide(c, x, i, here, x->k == k);
        if (x->k == k)
            return bits;
    }
    return bits + compact_bits(compact_mass(x->k, x->mu, x->sigma) / beyond(x, k, side));
}

static contexts *contexts_new(void)
{
    contexts *const c = compact_need(1, sizeof *c);

    compact_mixer_init(c->mixer[0], DECISIONS * WIDTHS, 0.9);
    ted4_adaptive_init(c->component[0][0],
                       (sizeof *c - offsetof(contexts, component)) / sizeof(ted4_adaptive));
    return c;
}

double compact_mixed(const compact_models *m, int type, const int32_t *near)
{
    contexts *const c = contexts_new();
    double bits = 0;

    for (unsigned comp = 0; comp < m->s->shape.dim[type]; comp++)
        for (size_t a = 0; a < m->n; a++)
            if (compact_coded(m->s, type, comp, a)) {
                const symbol x = describe(m, near, type, comp, a);

                bits += symbol_bits(c, &x);
            }
    free(c);
    return bits;
}

/* ---- masks ---- */

enum { SHARES = 5 };

typedef struct {
    compact_mixer mixer[2][TED4_MAX_OFFSETS];
    ted4_adaptive today[2][3], offset[TED4_MAX_OFFSETS][SHARES][2];
    ted4_adaptive count[TED4_MAX_OFFSETS + 1][TED4_MAX_OFFSETS + 1][SHARES];
    ted4_adaptive dynamic[SHARES], alone;
} mask_contexts;

/* How many of an anchor's near ones have a bit: 0 none of them known, otherwise 1 + share. */
static unsigned share(const uint16_t *bits, const int32_t *near, size_t a, unsigned bit)
{
    unsigned n = 0, ones = 0;

    for (size_t i = 0; i < COMPACT_NEAR; i++)
        if (near[COMPACT_NEAR * a + i] != COMPACT_NONE) {
            n++;
            ones += bits[near[COMPACT_NEAR * a + i]] >> bit & 1;
        }
    return n == 0 ? 0 : 1 + ones;
}

static double kept_nearby(const uint16_t *bits, const int32_t *near, size_t a, unsigned n_offsets)
{
    double kept = 0;

    for (unsigned o = 0; o < n_offsets; o++)
        kept += share(bits, near, a, o);
    return kept / n_offsets;
}

static double offset_bits(const ted4_scene *s, mask_contexts *c, const int32_t *near, size_t a,
                          double *adaptive)
{
    const unsigned dynamic = s->dynamic[a];
    const unsigned around = limit(kept_nearby(s->offset_bits, near, a, s->head.n_offsets), SHARES);
    unsigned kept = 0;
    double bits = 0;

    for (unsigned o = 0; o < s->head.n_offsets; o++) {
        const int value = s->offset_bits[a] >> o & 1;
        ted4_adaptive *const today = &c->today[dynamic][kept == o ? 1 : kept == 0 ? 0 : 2];
        compact_inputs in = { .given = today->p / 65536.0 };

        *adaptive += -log2((value ? today->p : 65536 - today->p) / 65536.0);
        ted4_adaptive_update(today, value);
        in.context[in.n++] = &c->offset[o][share(s->offset_bits, near, a, o)][dynamic];
        in.context[in.n++] = &c->count[o][kept][around];
        bits += compact_mix(&c->mixer[1][o], &in, value);
        kept += (unsigned)value;
    }
    return bits;
}

void compact_masks(const ted4_scene *s, const int32_t *near, double *adaptive, double *mixed)
{
    const size_t n = s->head.n_anchors;
    mask_contexts *const c = compact_need(1, sizeof *c);
    uint16_t *const moves = compact_need(n, sizeof *moves);

    *adaptive = *mixed = 0;
    compact_mixer_init(c->mixer[0], 2 * TED4_MAX_OFFSETS, 0.6);
    ted4_adaptive_init(c->today[0],
                       (sizeof *c - offsetof(mask_contexts, today)) / sizeof(ted4_adaptive));
    for (size_t a = 0; a < n; a++)
        moves[a] = s->dynamic[a];
    for (size_t a = 0; a < n; a++) {
        if (s->head.temporal_mask) {
            compact_inputs in = { .given = c->alone.p / 65536.0 };

            *adaptive += -log2((moves[a] ? c->alone.p : 65536 - c->alone.p) / 65536.0);
            ted4_adaptive_update(&c->alone, moves[a]);
            in.context[in.n++] = &c->dynamic[share(moves, near, a, 0)];
            *mixed += compact_mix(&c->mixer[0][0], &in, moves[a]);
        }
        if (s->head.offset_mask)
            *mixed += offset_bits(s, c, near, a, adaptive);
    }
    free(moves);
    free(c);
}
