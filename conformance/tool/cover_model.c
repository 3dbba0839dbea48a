/* cover_model.c - goals for the integer arithmetic of valid files: entries of tables, branches of
 * the coder, and bounds, clamps and ties of accumulators. The tiles of the file are decoded once
 * more by the decoder's own walk, with a coder and dense layers that count.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "base/bytes.h"
#include "cover.h"
#include "norm/half.h"
#include "norm/prior.h"
#include "norm/scene.h"
#include "read/reader.h"

enum { N_FRACTIONS = 256, KINDS = 5, MAX_LANES_LOG = 7, MAX_ESCAPE = 20, WORDS = 4, SHIFTS = 25 };

static const char *const kind_name[KINDS] = { "first hyper", "later hyper", "last hyper",
                                              "first slice", "last slice" };

/* What one file reaches. */
typedef struct {
    ted4_reader r; /* must be first */
    const ted4_coder_ops *plain;
    uint8_t sigma[TED4_N_SIGMA], phi[TED4_N_PHI], step[TED4_N_STEP], context_step[TED4_N_STEP],
        sine[TED4_N_SIN];
    uint8_t fraction[N_FRACTIONS], escape[2][MAX_ESCAPE], lanes[MAX_LANES_LOG], words[WORDS];
    uint8_t edge[8]; /* low escape, -hw, between, hw + 1, high escape; k at both ends of its range;
                        frequency 1 */
    uint8_t full[KINDS][2]; /* accumulator at 90 % of its bound, negative and positive */
    uint8_t tie[KINDS][2];  /* a requantised value that is a tie, negative and positive */
    uint8_t rail[8];
    uint8_t even[4]; /* weights and biases that are ties: to the even integer below, and above */
    uint8_t shift_out[SHIFTS];
} seen;

static seen *now; /* dense layers have no argument for it; the tool has a single thread */

static const char *const edge_name[8] = { "low escape",        "lowest of the window",
                                          "inside the window", "highest of the window",
                                          "high escape",       "k = -32767",
                                          "k = 32767",         "frequency 1" };
static const char *const rail_name[8] = { "hidden output cut at 32767",
                                          "hidden output cut at 0",
                                          "output at 2^26 - 1",
                                          "output at -(2^26 - 1)",
                                          "z at 2^17",
                                          "z at -2^17",
                                          "context at 32767",
                                          "context at -32767" };
static const char *const even_name[4] = { "weight, down to even", "weight, up to even",
                                          "bias, down to even", "bias, up to even" };

void conf_cover_model_goals(conf_cover *c)
{
    for (int i = 0; i < TED4_N_SIGMA; i++)
        conf_goal(c, "HALF and INV", "sigma index %d", i);
    for (int i = 0; i < TED4_N_PHI; i++)
        conf_goal(c, "PHI", "entry %d", i);
    for (int i = 0; i < TED4_N_STEP; i++)
        conf_goal(c, "STEP", "entry %d", i);
    for (int i = 0; i < TED4_N_STEP; i++)
        conf_goal(c, "STEPI in contexts", "entry %d", i);
    for (int i = 0; i < TED4_N_SIN; i++)
        conf_goal(c, "SIN", "entry %d", i);
    for (int i = 0; i < N_FRACTIONS; i++)
        conf_goal(c, "fractions of mu", "%d/256", i);
    for (int i = 0; i < MAX_ESCAPE; i++) {
        conf_goal(c, "escapes", "low, %d bits", i);
        conf_goal(c, "escapes", "high, %d bits", i);
    }
    for (int i = 0; i < MAX_LANES_LOG; i++)
        conf_goal(c, "lanes", "%d", 1 << i);
    for (int i = 0; i < 3; i++)
        conf_goal(c, "words a symbol takes", "%d", i);
    for (int i = 0; i < 8; i++) {
        conf_goal(c, "places of symbols", "%s", edge_name[i]);
        conf_goal(c, "rails", "%s", rail_name[i]);
    }
    for (int i = 0; i < KINDS; i++)
        for (int s = 0; s < 2; s++) {
            conf_goal(c, "accumulators at 90 % of 2^31", "%s layer, %s", kind_name[i],
                      s ? "positive" : "negative");
            conf_goal(c, "requantisation of ties", "%s layer, %s", kind_name[i],
                      s ? "positive" : "negative");
        }
    for (int i = 0; i < 4; i++)
        conf_goal(c, "integerisation of ties", "%s", even_name[i]);
    for (int i = 0; i < SHIFTS; i++)
        conf_goal(c, "output shifts", "%d", i);
}

/* Returns the kind of a layer, 0 .. 4, determined by its address in the prior. A layer outside the
 * prior is a part of the hyperprior's last layer (ted4_prior_some). */
static int kind_of(const ted4_prior *p, const ted4_int_layer *l)
{
    const ted4_int_layer *slice = p->slice[0];

    if (l >= slice && l < slice + sizeof p->slice / sizeof *slice)
        return (size_t)(l - slice) % TED4_SLICE_LAYERS == 0 ? 3 : 4;
    if (l >= p->hyper && l < p->hyper + p->n_hyper - 1)
        return l == p->hyper ? 0 : 1;
    return 2;
}

static const ted4_prior *prior_now;

static void note_sums(const ted4_int_layer *l, const int16_t *x, size_t n, int hidden)
{
    const int kind = kind_of(prior_now, l);

    for (unsigned o = 0; o < l->out; o++)
        for (size_t a = 0; a < n; a++) {
            int64_t acc = l->b[o];

            for (unsigned i = 0; i < l->in; i++)
                acc += (int64_t)l->w[(size_t)o * l->in_pad + i] *
                       x[(size_t)i * TED4_PRIOR_BLOCK + a];

            const int32_t y = ted4_round_shift((int32_t)acc, l->r[o]);

            now->full[kind][acc > 0] |= 10 * (acc < 0 ? -acc : acc) >= 9 * (int64_t)INT32_MAX;
            if (l->r[o] > 0 &&
                ((uint64_t)acc & (((uint64_t)1 << l->r[o]) - 1)) == (uint64_t)1 << (l->r[o] - 1))
                now->tie[kind][acc > 0] = 1;
            now->shift_out[l->r[o]] = 1;
            if (hidden) {
                now->rail[0] |= y > 32767;
                now->rail[1] |= y < 0;
            } else {
                now->rail[2] |= y > TED4_OUTPUT_MAX;
                now->rail[3] |= y < -TED4_OUTPUT_MAX;
            }
        }
}

static void hidden(const ted4_int_layer *l, const int16_t *x, size_t n, int16_t *y)
{
    note_sums(l, x, n, 1);
    ted4_int_dense_plain.hidden(l, x, n, y);
}

static void last(const ted4_int_layer *l, const int16_t *x, size_t n, int32_t *y)
{
    note_sums(l, x, n, 0);
    ted4_int_dense_plain.last(l, x, n, y);
}

static void note_cum(seen *s, unsigned g, int32_t fr, uint32_t j)
{
    if (j == 0 || j == ted4_gauss_size(g))
        return;

    const int32_t d = 256 * ((int32_t)j - 1 - ted4_half[g]) - 128 - fr;
    const int32_t raw = ted4_floor_shift(d * ted4_inv[g], 11),
                  z = ted4_clamp(raw, -(1 << 17), 1 << 17);
    const uint32_t i = (uint32_t)(z + (1 << 17)) / 256;

    s->phi[i] = 1;
    s->phi[i < 1024 ? i + 1 : 1024] = 1;
    s->rail[4] |= raw > 1 << 17;
    s->rail[5] |= raw < -(1 << 17);
}

static void note_symbol(seen *s, int32_t mu, unsigned g, int32_t k, unsigned words)
{
    const int32_t m = ted4_floor_shift(mu, TED4_MU_BITS), fr = mu - m * 256, hw = ted4_half[g],
                  r = k - m;
    const uint32_t j = r < -hw ? 0 : r > hw + 1 ? ted4_gauss_size(g) - 1 : (uint32_t)(r + hw + 1);

    s->sigma[g] = 1;
    s->fraction[fr] = 1;
    s->words[words < WORDS ? words : WORDS - 1] = 1;
    note_cum(s, g, fr, j);
    note_cum(s, g, fr, j + 1);
    s->edge[r < -hw ? 0 : r == -hw ? 1 : r > hw + 1 ? 4 : r == hw + 1 ? 3 : 2] = 1;
    s->edge[5] |= k == -32767;
    s->edge[6] |= k == 32767;
    s->edge[7] |= ted4_gauss_cum(g, fr, j + 1) - ted4_gauss_cum(g, fr, j) == 1;
    if (r < -hw || r > hw + 1) {
        const uint32_t e = (uint32_t)(r < -hw ? -hw - 1 - r : r - hw - 2);

        s->escape[r > 0][ted4_log2_floor(e + 1)] = 1;
    }
}

static void gauss(ted4_coder *c, size_t n, const int32_t *mu, const uint8_t *sigma, int16_t *k)
{
    seen *s = (seen *)c;

    for (size_t i = 0; i < n; i++) {
        const uint8_t *const before = s->r.rans.word;

        s->plain->gauss(c, 1, mu + i, sigma + i, k + i);
        if (c->error.code == TED4_OK)
            note_symbol(s, mu[i], sigma[i], k[i], (unsigned)((s->r.rans.word - before) / 2));
    }
}

static void open_substream(ted4_coder *c, size_t n)
{
    seen *s = (seen *)c;

    s->plain->open(c, n);
    if (n > 0)
        s->lanes[ted4_log2_floor(ted4_rans_lanes(n))] = 1;
}

static void note_ties(seen *s, const ted4_net_shape *n, const ted4_scene *scene, int hyper)
{
    size_t at = n->first, unit = n->first_unit;

    for (unsigned i = 0; i < n->n_layers; i++) {
        const ted4_unit_rule rule = ted4_prior_rule(n, i, hyper, scene->head.context_bits);
        const size_t n_w = (size_t)n->dim[i] * n->dim[i + 1];

        for (size_t j = 0; j < n_w + n->dim[i + 1]; j++) {
            const int bias = j >= n_w;
            const unsigned o = (unsigned)(bias ? j - n_w : j / (n->dim[i] > 0 ? n->dim[i] : 1));
            const int e = scene->shift[unit + o] + (bias ? rule.f : 0);
            const uint32_t u = ted4_float_bits(scene->nete.values[at + j]);
            const int64_t twice = ted4_rne_scaled(u, e + 1);

            /* twice the value is exact and odd: a tie */
            if (ted4_rne_scaled(u, e + 2) == 2 * twice && (twice & 1) != 0) {
                const int64_t rounded = ted4_rne_scaled(u, e);

                s->even[2 * bias + (2 * (rounded < 0 ? -rounded : rounded) >
                                    (twice < 0 ? -twice : twice))] = 1;
            }
        }
        at += n_w + n->dim[i + 1];
        unit += n->dim[i + 1];
    }
}

static void note_sines(seen *s, const ted4_scene *scene)
{
    for (size_t i = 0; scene->head.prior == TED4_PRIOR_INR && i < 3 * (size_t)scene->head.n_anchors;
         i++)
        for (unsigned l = 0; l < scene->head.pe_octaves; l++)
            for (uint32_t quarter = 0; quarter < 2; quarter++) {
                const uint32_t u = ((uint32_t)ted4_half_q24(scene->position[i]) << (7 + l)) +
                                   (quarter << 30);

                s->sine[u >> 22] = s->sine[(u >> 22) + 1] = 1;
            }
}

static void note_steps(seen *s, const ted4_scene *scene)
{
    const size_t n = scene->head.n_anchors;

    for (size_t a = 0; a < n; a++) {
        for (int t = 0; t < TED4_TYPES; t++)
            if (scene->shape.dim[t] > 0)
                s->step[scene->step_index[t][a]] = 1;
        for (unsigned c = 0;
             scene->head.n_slices > 1 &&
             c + scene->head.slice[scene->head.n_slices - 1] < scene->head.feature_dim;
             c++) {
            const int16_t k = scene->symbol[TED4_FEATURE][c * n + a];
            const uint8_t q = scene->step_index[TED4_FEATURE][a];
            const int32_t x = ted4_round_shift(k * ted4_stepi[q], 12 - scene->head.context_bits);

            s->context_step[q] |= k != 0;
            s->rail[6] |= x > 32767;
            s->rail[7] |= x < -32767;
        }
    }
}

static void reach_all(conf_cover *c, const char *id, const char *group, const char *format,
                      const uint8_t *flag, int n)
{
    for (int i = 0; i < n; i++)
        if (flag[i]) {
            char name[64];

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wformat-nonliteral"
            snprintf(name, sizeof name, format, i);
#pragma GCC diagnostic pop
            conf_reach(c, group, id, "%s", name);
        }
}

static void report(conf_cover *c, const char *id, const seen *s)
{
    reach_all(c, id, "HALF and INV", "sigma index %d", s->sigma, TED4_N_SIGMA);
    reach_all(c, id, "PHI", "entry %d", s->phi, TED4_N_PHI);
    reach_all(c, id, "STEP", "entry %d", s->step, TED4_N_STEP);
    reach_all(c, id, "STEPI in contexts", "entry %d", s->context_step, TED4_N_STEP);
    reach_all(c, id, "SIN", "entry %d", s->sine, TED4_N_SIN);
    reach_all(c, id, "fractions of mu", "%d/256", s->fraction, N_FRACTIONS);
    reach_all(c, id, "escapes", "low, %d bits", s->escape[0], MAX_ESCAPE);
    reach_all(c, id, "escapes", "high, %d bits", s->escape[1], MAX_ESCAPE);
    reach_all(c, id, "words a symbol takes", "%d", s->words, WORDS);
    reach_all(c, id, "output shifts", "%d", s->shift_out, SHIFTS);
    for (int i = 0; i < MAX_LANES_LOG; i++)
        if (s->lanes[i])
            conf_reach(c, "lanes", id, "%d", 1 << i);
    for (int i = 0; i < 8; i++) {
        if (s->edge[i])
            conf_reach(c, "places of symbols", id, "%s", edge_name[i]);
        if (s->rail[i])
            conf_reach(c, "rails", id, "%s", rail_name[i]);
        if (i < 4 && s->even[i])
            conf_reach(c, "integerisation of ties", id, "%s", even_name[i]);
    }
    for (int i = 0; i < 2 * KINDS; i++) {
        const char *const sign = i % 2 ? "positive" : "negative";

        if (s->full[i / 2][i % 2])
            conf_reach(c, "accumulators at 90 % of 2^31", id, "%s layer, %s", kind_name[i / 2],
                       sign);
        if (s->tie[i / 2][i % 2])
            conf_reach(c, "requantisation of ties", id, "%s layer, %s", kind_name[i / 2], sign);
    }
}

/* Reads every TILE of the file again. */
static void walk_tiles(seen *s, ted4_scene *scene, const ted4_prior *prior, const conf_bytes *file,
                       void *work)
{
    unsigned tile = 0;

    for (size_t at = 12; at + 20 <= file->size;) {
        const size_t size = ted4_load32(file->data + at + 8);

        if (memcmp(file->data + at, "TILE", 4) == 0) {
            ted4_coder_ops ops;

            ted4_reader_init(&s->r, file->data, at + 12, at + 12 + size, 0);
            s->plain = s->r.base.ops;
            ops = *s->plain;
            ops.gauss = gauss;
            ops.open = open_substream;
            s->r.base.ops = &ops;
            ted4_walk_tile(&s->r.base, scene, prior, tile++, work);
        }
        at += size + 20;
    }
}

void conf_cover_model(conf_cover *c, const conf_entry *e, const conf_bytes *file)
{
    static const ted4_int_dense counting = { hidden, last };
    seen *s = conf_alloc(1, sizeof *s);
    ted4_scene *scene;
    ted4_error why;
    ted4_arena arena;
    ted4_prior prior;
    void *work;

    if (ted4_decode(file->data, file->size, NULL, &scene, &why) != TED4_OK)
        conf_die("%s: should be valid", e->id);
    ted4_arena_init(&arena, NULL);
    work = ted4_arena_alloc(&arena, 1, ted4_tile_work_size(scene));
    if (work == NULL || ted4_prior_init(&prior, &scene->head, &scene->shape, &arena) != TED4_OK ||
        ted4_prior_load(&prior, scene->nete.values, scene->shift, NULL) != TED4_OK)
        conf_die("no memory");
    prior.dense = &counting;
    prior_now = &prior;
    now = s;
    note_ties(s, &scene->shape.hyper, scene, 1);
    for (unsigned m = 1; m < scene->head.n_slices; m++)
        note_ties(s, &scene->shape.slice[m], scene, 0);
    note_sines(s, scene);
    note_steps(s, scene);
    walk_tiles(s, scene, &prior, file, work);
    report(c, e->id, s);
    ted4_arena_finish(&arena);
    ted4_scene_free(scene);
    free(s);
}
