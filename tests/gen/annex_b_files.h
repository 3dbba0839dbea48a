/* annex_b_files.h - the two files of annex B, made from numbers chosen by hand.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_ANNEX_B_FILES_H
#define TED4_ANNEX_B_FILES_H

#include <stdlib.h>
#include <string.h>
#include "norm/half.h"
#include "norm/scene.h"
#include "write/encode.h"

/* Bits of a DEFLATE stream, from the lowest of each byte. */
typedef struct {
    uint8_t byte[16];
    unsigned n_bits;
} annex_b_bits;

static inline void annex_b_bit(annex_b_bits *b, unsigned bit)
{
    b->byte[b->n_bits / 8] |= (uint8_t)(bit << b->n_bits % 8);
    b->n_bits++;
}

/* n bits of a number, the lowest first; of a code, the highest first. */
static inline void annex_b_number(annex_b_bits *b, unsigned value, unsigned n)
{
    for (unsigned i = 0; i < n; i++)
        annex_b_bit(b, value >> i & 1);
}

static inline void annex_b_code(annex_b_bits *b, unsigned code, unsigned n)
{
    while (n-- > 0)
        annex_b_bit(b, code >> n & 1);
}

/* A zlib stream of n zero bytes, 84 <= n <= 99, by the fixed code: the literal 0, then a match of n
 * - 1 at distance 1. 11 bytes. */
static inline size_t annex_b_zeros(uint8_t out[16], unsigned n)
{
    annex_b_bits b = { { 0x78, 0x01 }, 16 };

    annex_b_number(&b, 1, 1);       /* last block */
    annex_b_number(&b, 1, 2);       /* fixed code */
    annex_b_code(&b, 0x30, 8);      /* literal 0 */
    annex_b_code(&b, 278 - 256, 7); /* lengths 83 .. 98 */
    annex_b_number(&b, n - 1 - 83, 4);
    annex_b_code(&b, 0, 5); /* distance 1 */
    annex_b_code(&b, 0, 7); /* end */
    b.n_bits = (b.n_bits + 7) / 8 * 8;
    for (unsigned i = 0; i < 4; i++) /* Adler-32, highest byte first: b = n, a = 1 */
        annex_b_number(&b, i == 1 ? n : i == 3 ? 1 : 0, 8);
    memcpy(out, b.byte, sizeof b.byte);
    return b.n_bits / 8;
}

static inline void annex_b_common(ted4_header *h)
{
    memset(h, 0, sizeof *h);
    h->tile_size = 64;
    h->feature_dim = h->n_offsets = h->n_slices = h->slice[0] = 1;
    for (int t = 0; t < TED4_TYPES; t++)
        h->step[t] = 1.0f;
    h->frames = h->rate_num = h->rate_den = 1;
}

/* B.1: one anchor, one Gaussian, all networks 0. */
static inline ted4_scene *annex_b_smallest(void)
{
    static uint8_t nete[16], netr[16];
    static const int16_t scaling[6] = { -1, 0, 0, 1, 0, 0 }, offset[3] = { 1, 0, -1 };
    ted4_header h;
    ted4_scene *s;

    annex_b_common(&h);
    h.n_anchors = 1;
    h.prior = TED4_PRIOR_FACTORISED;
    s = ted4_scene_new(&h, NULL);
    s->nete.mode = s->netr.mode = TED4_BLOB_DEFLATED;
    s->nete.deflated = nete;
    s->nete.deflated_size = annex_b_zeros(nete, 4 * (unsigned)s->nete.n);
    s->netr.deflated = netr;
    s->netr.deflated_size = annex_b_zeros(netr, 4 * (unsigned)s->netr.n);
    memset(s->shift, 8, s->shape.n_units);
    s->offset_bits[0] = 1;
    s->symbol[TED4_FEATURE][0] = 1;
    memcpy(s->symbol[TED4_SCALING], scaling, sizeof scaling);
    memcpy(s->symbol[TED4_OFFSET], offset, sizeof offset);
    return s;
}

/* Value o of layer i's biases, or its weight from input k. */
static inline float *annex_b_bias(float *values, const ted4_net_shape *n, unsigned o)
{
    return values + n->first + (size_t)n->dim[0] * n->dim[1] + o;
}

static inline void annex_b_networks(ted4_scene *s)
{
    const ted4_net_shape *const r = s->shape.netr;
    float *e = s->nete.values, *v = s->netr.values;
    float *const last = v + r[TED4_NET_DEFORM].first + 2;

    e[0] = 0.5f;                                    /* mu of feature 0 from x */
    e[3 * 2] = 0.25f;                               /* s of feature 0 from x */
    e[3 * 4 + 1] = -1.5f;                           /* mu of scaling 0 from y */
    *annex_b_bias(e, &s->shape.hyper, 4) = -12.0f;  /* mu of scaling 0 */
    *annex_b_bias(e, &s->shape.hyper, 10) = -0.75f; /* s of scaling 0 */
    e[3 * 42] = 0.5f;                               /* v of tau from x */
    e[s->shape.slice[1].first] = 1.0f;              /* slice network: hidden unit */
    e[s->shape.slice[1].first + 2] = 0.75f;         /* what it adds to mu */
    v[r[TED4_NET_PROJECT].first] = 1.0f;
    v[r[TED4_NET_PROJECT].first + 1] = 0.5f;
    v[r[TED4_NET_DEFORM].first] = 1.0f;
    last[0] = 0.25f; /* x moves */
    last[3] = -0.5f; /* feature 0 changes */
    v[r[TED4_NET_OPACITY].first] = 0.25f;
    *annex_b_bias(v, &r[TED4_NET_OPACITY], 0) = 1.0f;
    *annex_b_bias(v, &r[TED4_NET_OPACITY], 1) = 2.0f;
    for (unsigned k = 0; k < 2; k++)
        *annex_b_bias(v, &r[TED4_NET_COVARIANCE], 7 * k + 3) = 1.0f;
    v[r[TED4_NET_COVARIANCE].first] = 0.5f;     /* a scale from feature 0 */
    v[r[TED4_NET_COLOUR].first] = 0.5f;         /* red from feature 0 */
    v[r[TED4_NET_COLOUR].first + 5 + 4] = 1.0f; /* green from the view direction's z */
    s->bank.values[0] = -1.0f;
    s->bank.values[1] = 1.0f;
}

/* B.2: two anchors, one of which moves and comes and goes. */
static inline ted4_scene *annex_b_dynamic(void)
{
    static const float position[2][3] = { { -0.25f, 0.5f, 0.0f }, { 0.5f, 0.25f, 1.0f } };
    static const int16_t feature[2][2] = { { 1, -60 }, { 2, 3 } };
    static const int16_t tau[4] = { 3, -2, 6, -1 };
    ted4_header h;
    ted4_scene *s;

    annex_b_common(&h);
    h.n_anchors = 2;
    h.n_offsets = h.feature_dim = h.n_slices = h.slice[1] = 2;
    h.slice[1] = 1;
    h.motion = TED4_MOTION_BANK;
    h.phi_dim = 1;
    h.bank_rows = 2;
    h.bank_dim = h.deform_layers = 1;
    h.deform_width = 1;
    h.temporal_mask = h.offset_mask = h.activation = 1;
    h.view = TED4_VIEW_COLOUR;
    h.ar_width = 1;
    h.context_bits = 8;
    h.step[TED4_SCALING] = h.step[TED4_OFFSET] = 0.25f;
    h.step[TED4_PHI] = 0.5f;
    h.step[TED4_TAU] = 0.125f;
    h.frames = 5;
    h.rate_num = 25;
    h.origin[2] = 4.0f;
    h.exponent = 1;
    h.background[2] = 64;
    s = ted4_scene_new(&h, NULL);
    s->nete.mode = s->netr.mode = s->bank.mode = TED4_BLOB_RAW;
    memset(s->shift, 8, s->shape.n_units);
    annex_b_networks(s);
    for (int i = 0; i < 6; i++)
        s->position[i] = ted4_float_to_half((&position[0][0])[i]);
    s->dynamic[1] = 1;
    s->offset_bits[0] = 1;
    s->offset_bits[1] = 3;
    for (int i = 0; i < 2; i++) {
        for (int c = 0; c < 2; c++)
            s->symbol[TED4_FEATURE][2 * c + i] = feature[i][c];
        s->symbol[TED4_SCALING][i] = (int16_t)(-12 - i);
        s->symbol[TED4_SCALING][6 + i] = -1;
        s->symbol[TED4_OFFSET][i] = 1;
        for (int c = 0; c < 4; c++)
            s->symbol[TED4_TAU][2 * c + i] = i == 0 ? (int16_t)(c == 2) : tau[c];
    }
    s->symbol[TED4_OFFSET][6 + 1] = -2;
    s->symbol[TED4_PHI][1] = 1;
    return s;
}

/* The file; *size bytes, to be freed. Ends the program when the scene is refused. */
static inline uint8_t *annex_b_encode(ted4_scene *s, size_t *size)
{
    uint8_t *data = NULL;
    ted4_error e = { TED4_OK, 0 };

    if (s == NULL || ted4_scene_steps(s, NULL, &e) != TED4_OK ||
        ted4_encode(s, 0, NULL, &data, size, &e) != TED4_OK) {
        fprintf(stderr, "annex B: %s\n", ted4_status_id(e.code));
        abort();
    }
    ted4_scene_free(s);
    return data;
}

#endif
