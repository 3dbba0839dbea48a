/* random_scene.h - random valid scenes for tests: header, networks on the integer grid, sorted
 * positions, masks, step indices, and symbols drawn from the scene's own entropy model. Header
 * only; link libted4enc and libted4dec.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_RANDOM_SCENE_H
#define TED4_RANDOM_SCENE_H

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "norm/half.h"
#include "norm/prior.h"
#include "norm/scene.h"
#include "random_source.h"
#include "write/encode.h"
#include "write/snap.h"

/* The configuration of the paper's method: F = 50 in slices 5, 10, 15, 20, K = 10, hyperprior
 * 63-100-100. */
static inline ted4_header random_paper_header(uint32_t n_anchors)
{
    ted4_header h;

    memset(&h, 0, sizeof h);
    h.n_anchors = n_anchors;
    h.tile_size = 4096;
    h.n_offsets = 10;
    h.feature_dim = 50;
    h.motion = TED4_MOTION_BANK;
    h.phi_dim = 8;
    h.bank_rows = 75;
    h.bank_dim = 128;
    h.deform_layers = 2;
    h.deform_width = 128;
    h.temporal_mask = h.offset_mask = h.activation = 1;
    h.view = TED4_VIEW_COLOUR;
    h.head_layers = 1;
    h.head_width = 50;
    h.pe_octaves = 10;
    h.hyper_layers = 2;
    h.hyper_width = 100;
    h.n_slices = 4;
    memcpy(h.slice, "\5\12\17\24", 4);
    h.ar_width = 100;
    h.context_bits = 8;
    for (int t = 0; t < TED4_TYPES; t++)
        h.step[t] = t == TED4_SCALING ? 0.01f : t == TED4_FEATURE ? 1.0f : 0.2f;
    h.frames = 150;
    h.rate_num = 30;
    h.rate_den = 1;
    h.exponent = 3;
    return h;
}

/* A small configuration of the same method: n_anchors in tiles of 64, two slices. */
static inline ted4_header random_small_header(uint32_t n_anchors)
{
    ted4_header h = random_paper_header(n_anchors);

    h.tile_size = 64;
    h.feature_dim = 8;
    h.n_slices = 2;
    h.slice[0] = 3;
    h.slice[1] = 5;
    h.n_offsets = 4;
    h.bank_rows = 5;
    h.bank_dim = 4;
    h.deform_width = h.head_width = h.hyper_width = h.ar_width = 8;
    h.frames = 20;
    return h;
}

/* Compilers differ in the order in which they evaluate the arguments of a call, so each statement
 * draws one number. */
static inline float random_step(random_source *r)
{
    const int exponent = (int)random_in(r, 0, 25) - 18;

    return ldexpf((float)(0.5 + random_unit(r) / 2), exponent);
}

/* Draws any header whose values are in range, small enough that a test can try thousands. */
static inline ted4_header random_header(random_source *r)
{
    ted4_header h;
    unsigned left, i;

    memset(&h, 0, sizeof h);
    h.n_anchors = random_in(r, 1, 300);
    h.tile_size = random_in(r, 64, 200);
    h.n_offsets = (uint8_t)random_in(r, 1, 10);
    h.feature_dim = (uint8_t)random_in(r, 1, 24);
    h.motion = (uint8_t)random_in(r, 0, 3);
    if (h.motion == TED4_MOTION_BANK || h.motion == TED4_MOTION_CONCAT) {
        h.phi_dim = (uint8_t)random_in(r, 1, 8);
        h.bank_rows = random_in(r, 1, 9);
        h.bank_dim = (uint16_t)random_in(r, 1, 16);
    }
    if (h.motion != TED4_MOTION_NONE) {
        h.deform_layers = (uint8_t)random_in(r, 1, 3);
        h.deform_width = (uint16_t)random_in(r, 1, 20);
        h.temporal_mask = (uint8_t)random_in(r, 0, 1);
    }
    h.offset_mask = (uint8_t)random_in(r, 0, 1);
    h.activation = (uint8_t)random_in(r, 0, 1);
    h.view = (uint8_t)random_in(r, 0, 2);
    h.head_layers = (uint8_t)random_in(r, 0, 2);
    h.head_width = (uint16_t)(h.head_layers ? random_in(r, 1, 16) : 0);
    h.scale_domain = (uint8_t)random_in(r, 0, 1);
    h.prior = (uint8_t)random_in(r, 0, 1);
    if (h.prior == TED4_PRIOR_INR) {
        h.pe_octaves = (uint8_t)random_in(r, 0, 12);
        h.hyper_layers = (uint8_t)random_in(r, 0, 3);
        h.hyper_width = (uint16_t)(h.hyper_layers ? random_in(r, 1, 30) : 0);
    }
    for (i = 0, left = h.feature_dim; left > 0; i++, left -= h.slice[i - 1])
        h.slice[i] = (uint8_t)(i == 3 ? left : random_in(r, 1, left));
    h.n_slices = (uint8_t)i;
    h.ar_width = (uint16_t)(i > 1 ? random_in(r, 1, 30) : 0);
    h.context_bits = (uint8_t)random_in(r, 0, 12);
    for (int t = 0; t < TED4_TYPES; t++)
        h.step[t] = random_step(r);
    h.frames = random_in(r, 1, 60);
    h.rate_num = random_in(r, 1, 60000);
    h.rate_den = random_in(r, 1, 1001);
    for (int j = 0; j < 3; j++)
        h.origin[j] = (float)random_normal(r);
    h.exponent = (int8_t)((int)random_in(r, 0, 60) - 30);
    for (int j = 0; j < 3; j++)
        h.background[j] = (uint8_t)random_u32(r);
    return h;
}

static inline void random_layer(random_source *r, float *v, unsigned in, unsigned out, double gain,
                                double bias)
{
    for (size_t i = 0; i < (size_t)in * out; i++)
        v[i] = (float)(random_normal(r) * gain / sqrt(in));
    for (unsigned o = 0; o < out; o++)
        v[(size_t)in * out + o] = (float)(random_normal(r) * bias);
}

static inline void random_net(random_source *r, float *values, const ted4_net_shape *n, double bias)
{
    size_t at = n->first;

    for (unsigned i = 0; i < n->n_layers; i++) {
        random_layer(r, values + at, n->dim[i], n->dim[i + 1], i + 1u < n->n_layers ? 1.4 : 0.7,
                     bias);
        at += (n->dim[i] + (size_t)1) * n->dim[i + 1];
    }
}

static inline void random_positions(random_source *r, ted4_scene *s)
{
    const size_t n = s->head.n_anchors, tries = n + n / 8 + 16;
    uint16_t *p = malloc(3 * tries * sizeof *p);
    uint32_t *order = malloc(tries * sizeof *order);
    size_t kept;

    for (size_t i = 0; i < 3 * tries; i++) {
        double x = random_normal(r) / 3;

        if (random_in(r, 0, 63) == 0)
            x *= 1e-5;
        p[i] = ted4_float_to_half((float)(x < -1 ? -1 : x > 1 ? 1 : x));
        if (p[i] == 0x8000)
            p[i] = 0;
    }
    kept = ted4_positions_sort(p, tries, order);
    /* The kept positions are sorted; skip single ones so that n remain. */
    for (size_t i = 0; i < n; i++)
        memcpy(s->position + 3 * i, p + 3 * order[i * kept / n], 6);
    free(p);
    free(order);
}

/* Draws positions of different places on a grid of so many bits, 6 .. 12, in the order of their
 * keys. At most a quarter of the places may be taken. */
static inline void random_grid_positions(random_source *r, ted4_scene *s, unsigned grid)
{
    const size_t n = s->head.n_anchors;
    const uint32_t most = ((uint32_t)1 << grid) - 1;
    uint64_t *key = malloc(n * sizeof *key);
    size_t kept = 0;

    while (kept < n) {
        uint64_t k = 0;
        size_t at = kept;

        for (int j = 0; j < 3; j++) {
            const double x = (random_normal(r) / 6 + 0.5) * (most + 1);

            k = k << 1 | ted4_spread3(x < 0 ? 0 : x > most ? most : (uint32_t)x);
        }
        while (at > 0 && key[at - 1] > k)
            at--;
        if (at > 0 && key[at - 1] == k)
            continue;
        memmove(key + at + 1, key + at, (kept++ - at) * sizeof *key);
        key[at] = k;
    }
    for (size_t i = 0; i < 3 * n; i++)
        s->position[i] = ted4_grid_half(ted4_gather3(key[i / 3] >> (2 - i % 3)), grid);
    free(key);
}

static inline void random_masks(random_source *r, ted4_scene *s)
{
    const uint16_t all = (uint16_t)((1u << s->head.n_offsets) - 1);

    for (size_t i = 0; i < s->head.n_anchors; i++) {
        s->dynamic[i] = s->head.motion != TED4_MOTION_NONE;
        if (s->head.temporal_mask)
            s->dynamic[i] = random_in(r, 0, 4) == 0;
        s->offset_bits[i] = all;
        if (s->head.offset_mask)
            s->offset_bits[i] = (uint16_t)(all & (random_u32(r) | random_u32(r)));
    }
}

/* Draws the symbols of one component from mu and s of a block of anchors. wild: some are large, so
 * that escapes occur. */
static inline void random_symbols(random_source *r, const int32_t *mu, const int32_t *s, size_t n,
                                  int wild, int16_t *k)
{
    for (size_t i = 0; i < n; i++) {
        const double sigma = exp2((ted4_sigma_index(s[i]) - 64) / 16.0);
        double x = mu[i] / 256.0 + sigma * random_normal(r);

        if (wild && random_in(r, 0, 30) == 0) {
            x = random_normal(r);
            x *= exp2(random_in(r, 0, 15));
        }
        k[i] = (int16_t)(x < -32767 ? -32767 : x > 32767 ? 32767 : rint(x));
    }
}

/* Draws all symbols of a block of n <= 64 anchors, starting at anchor a. */
static inline void random_block(random_source *r, ted4_scene *s, const ted4_prior *p, size_t a,
                                size_t n, int wild)
{
    const ted4_shape *sh = &s->shape;
    const size_t N = s->head.n_anchors;
    int32_t *out = malloc(sizeof *out * 64 * sh->n_outputs);
    int32_t *add = malloc(sizeof *add * 64 * 2 * TED4_MAX_FEATURE);
    int16_t *ctx = calloc(64 * TED4_MAX_FEATURE, sizeof *ctx);
    unsigned comp = 0;

    ted4_prior_hyper(p, s->position + 3 * a, n, out);
    for (unsigned m = 0; m < s->head.n_slices; m++) {
        const unsigned dim = s->head.slice[m];

        if (m > 0)
            ted4_prior_slice(p, m, ctx, n, add);
        for (unsigned c = 0; c < dim; c++, comp++) {
            int32_t *mu = out + 64 * (size_t)comp;
            int32_t *sg = mu + 64 * (size_t)s->head.feature_dim;
            int16_t *k = s->symbol[TED4_FEATURE] + comp * N + a;

            for (size_t i = 0; m > 0 && i < n; i++) {
                mu[i] += add[64 * c + i];
                sg[i] += add[64 * (dim + c) + i];
            }
            random_symbols(r, mu, sg, n, wild, k);
            for (size_t i = 0; i < n; i++)
                ctx[64 * comp + i] =
                    ted4_context(k[i], s->step_index[TED4_FEATURE][a + i], p->context_bits);
        }
    }
    for (int t = TED4_SCALING; t < TED4_TYPES; t++)
        for (unsigned c = 0; c < sh->dim[t]; c++)
            random_symbols(r, out + 64 * (size_t)(sh->first_output[t] + c),
                           out + 64 * (size_t)(sh->first_output[t] + sh->dim[t] + c), n, wild,
                           s->symbol[t] + c * N + a);
    free(out);
    free(add);
    free(ctx);
}

/* Sets symbols that a mask hides to 0, as a decoder does, and enforces a_s <= a_f. */
static inline void random_tidy(ted4_scene *s)
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

static inline void random_weights(random_source *r, ted4_scene *s, int wild)
{
    const ted4_header *h = &s->head;

    random_net(r, s->nete.values, &s->shape.hyper, wild ? 1.5 : 0.3);
    for (unsigned m = 1; m < h->n_slices; m++)
        random_net(r, s->nete.values, &s->shape.slice[m], 0.1);
    ted4_snap(h, &s->shape, s->nete.values, s->shift);
    for (int i = 0; i < TED4_NETS_R; i++)
        random_net(r, s->netr.values, &s->shape.netr[i], 0.2);
    for (size_t i = 0; i < s->bank.n; i++)
        s->bank.values[i] = random_in(r, 0, 3) ? (float)random_normal(r) : 0;
}

/* Draws masks and symbols of a scene whose networks and positions are there. Returns 0 if memory
 * ran out. */
static inline int random_symbols_of(random_source *r, ted4_scene *s, int wild)
{
    const ted4_header *h = &s->head;
    ted4_arena arena;
    ted4_prior p;

    random_masks(r, s);
    ted4_arena_init(&arena, NULL);
    if (ted4_prior_init(&p, h, &s->shape, &arena) != TED4_OK ||
        ted4_prior_load(&p, s->nete.values, s->shift, NULL) != TED4_OK ||
        ted4_scene_steps(s, NULL, NULL) != TED4_OK) {
        ted4_arena_finish(&arena);
        return 0;
    }
    for (size_t a = 0; a < h->n_anchors; a += 64)
        random_block(r, s, &p, a, h->n_anchors - a < 64 ? h->n_anchors - a : 64, wild);
    random_tidy(s);
    ted4_arena_finish(&arena);
    return 1;
}

/* Returns a scene with that header that ted4_encode accepts, or NULL if memory ran out. wild: with
 * escapes. Free with ted4_scene_free. */
static inline ted4_scene *random_scene_of(random_source *r, const ted4_header *h, int wild)
{
    ted4_scene *s = ted4_scene_new(h, NULL);

    if (s == NULL)
        return NULL;
    random_weights(r, s, wild);
    random_positions(r, s);
    if (random_symbols_of(r, s, wild))
        return s;
    ted4_scene_free(s);
    return NULL;
}

/* Rounds to multiples of a power of two that differs from place to place, so that a writer of
 * profile Compact codes the values as integers (spec 7.6). */
static inline void random_coarse(random_source *r, ted4_blob *b)
{
    int bits = 6;

    for (size_t i = 0; i < b->n; i++) {
        if (random_in(r, 0, 15) == 0)
            bits = (int)random_in(r, 3, 12);
        b->values[i] = ldexpf(rintf(ldexpf(b->values[i], bits)), -bits) + 0.0f; /* no -0 */
    }
}

/* Like random_scene_of, of profile Compact: positions lie on a grid of so many bits (spec 8.2), and
 * weights are coarse enough to be coded as integers. */
static inline ted4_scene *random_compact_of(random_source *r, const ted4_header *h, int wild,
                                            unsigned grid)
{
    ted4_scene *s = ted4_scene_new(h, NULL);

    if (s == NULL)
        return NULL;
    s->profile = TED4_PROFILE_COMPACT;
    s->grid = (uint8_t)grid;
    random_weights(r, s, wild);
    random_coarse(r, &s->netr);
    random_coarse(r, &s->bank);
    if (grid < 16)
        random_grid_positions(r, s, grid);
    else
        random_positions(r, s);
    if (random_symbols_of(r, s, wild))
        return s;
    ted4_scene_free(s);
    return NULL;
}

/* Returns a small scene with a random header. */
static inline ted4_scene *random_scene(uint64_t seed)
{
    random_source r = random_seed(seed);
    const ted4_header h = random_header(&r);

    return random_scene_of(&r, &h, seed % 2 == 1);
}

#endif
