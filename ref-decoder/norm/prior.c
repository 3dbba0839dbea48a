/* prior.c - spec 7.3, 10.1, 10.3: converts the networks of Tier E to integers and evaluates them.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "norm/prior.h"

#include <string.h>
#include "base/bytes.h"
#include "norm/half.h"
#include "norm/sine.h"

static int layer_init(ted4_int_layer *l, unsigned in, unsigned out, ted4_arena *arena)
{
    l->in = in;
    l->in_pad = in + in % 2;
    l->out = out;
    l->w = ted4_arena_alloc(arena, (size_t)out * l->in_pad, sizeof *l->w);
    l->b = ted4_arena_alloc(arena, out, sizeof *l->b);
    l->r = ted4_arena_alloc(arena, out, sizeof *l->r);
    return l->w != NULL && l->b != NULL && l->r != NULL;
}

static int net_init(ted4_int_layer *l, const ted4_net_shape *n, ted4_arena *arena)
{
    for (unsigned i = 0; i < n->n_layers; i++)
        if (!layer_init(&l[i], n->dim[i], n->dim[i + 1], arena))
            return 0;
    return 1;
}

ted4_status ted4_prior_init(ted4_prior *p, const ted4_header *h, const ted4_shape *s,
                            ted4_arena *arena)
{
    memset(p, 0, sizeof *p);
    p->dense = &ted4_int_dense_plain;
    p->pe_octaves = h->pe_octaves;
    p->context_bits = h->context_bits;
    p->n_inputs = s->hyper.dim[0];
    p->n_outputs = s->n_outputs;
    p->n_slices = h->n_slices;
    memcpy(p->slice_dim, h->slice, sizeof p->slice_dim);
    p->n_hyper = s->hyper.n_layers;
    p->hyper_shape = s->hyper;
    memcpy(p->slice_shape, s->slice, sizeof p->slice_shape);
    if (!net_init(p->hyper, &s->hyper, arena))
        return TED4_E_LIMIT_MEMORY;
    for (unsigned m = 1; m < p->n_slices; m++)
        if (!net_init(p->slice[m], &s->slice[m], arena))
            return TED4_E_LIMIT_MEMORY;
    return TED4_OK;
}

ted4_unit_rule ted4_prior_rule(const ted4_net_shape *n, unsigned i, int hyper,
                               unsigned context_bits)
{
    ted4_unit_rule u;

    u.f = i > 0 ? TED4_HIDDEN_BITS : hyper ? TED4_INPUT_BITS : (int)context_bits;
    u.g = i + 1u < n->n_layers ? TED4_HIDDEN_BITS : TED4_OUTPUT_BITS;
    u.amplitude = i == 0 && hyper ? 1 << TED4_INPUT_BITS : 32767;
    return u;
}

/* Loads one layer, whose f32 values start at nete[at]: all of W, then all of b (spec 7.1). */
static void layer_load(ted4_int_layer *l, const ted4_unit_rule *u, const float *nete, size_t at,
                       const uint8_t *shift, ted4_error *e)
{
    for (unsigned o = 0; o < l->out; o++)
        for (unsigned i = 0; i < l->in; i++, at++) {
            const uint32_t bits = ted4_float_bits(nete[at]);
            const int64_t w = ted4_rne_scaled(bits, shift[o]);

            if (!ted4_float_legal(bits))
                ted4_fail(e, TED4_E_NET_VALUE, at);
            if (w < -32767 || w > 32767)
                ted4_fail(e, TED4_E_NET_WEIGHT_RANGE, at);
            if (e->code != TED4_OK)
                return;
            l->w[(size_t)o * l->in_pad + i] = (int16_t)w;
        }
    for (unsigned o = 0; o < l->out; o++, at++) {
        const uint32_t bits = ted4_float_bits(nete[at]);
        const int64_t b = ted4_rne_scaled(bits, shift[o] + u->f);
        int64_t sum = 0;

        for (unsigned i = 0; i < l->in; i++) {
            const int32_t w = l->w[(size_t)o * l->in_pad + i];

            sum += w < 0 ? -w : w;
        }
        if (!ted4_float_legal(bits))
            ted4_fail(e, TED4_E_NET_VALUE, at);
        if (!ted4_accumulator_legal(u, shift[o], sum, b))
            ted4_fail(e, TED4_E_NET_ACCUMULATOR, at);
        if (e->code != TED4_OK)
            return;
        l->b[o] = (int32_t)b;
        l->r[o] = (uint8_t)(shift[o] + u->f - u->g);
    }
}

/* If nete is NULL, checks the shifts only, which precede the values in a file; otherwise loads the
 * values. */
static void net_load(ted4_prior *p, ted4_int_layer *l, const ted4_net_shape *n, int hyper,
                     const float *nete, const uint8_t *shift, ted4_error *e)
{
    size_t at = n->first, unit = n->first_unit;

    for (unsigned i = 0; i < n->n_layers && e->code == TED4_OK; i++) {
        const ted4_unit_rule u = ted4_prior_rule(n, i, hyper, p->context_bits);

        if (nete != NULL)
            layer_load(&l[i], &u, nete, at, shift + unit, e);
        else
            for (unsigned o = 0; o < l[i].out; o++)
                if (!ted4_shift_legal(&u, shift[unit + o]))
                    ted4_fail(e, TED4_E_NET_SHIFT, unit + o);
        at += ((size_t)l[i].in + 1) * l[i].out;
        unit += l[i].out;
    }
}

static void load_all(ted4_prior *p, const float *nete, const uint8_t *shift, ted4_error *e)
{
    net_load(p, p->hyper, &p->hyper_shape, 1, nete, shift, e);
    for (unsigned m = 1; m < p->n_slices; m++)
        net_load(p, p->slice[m], &p->slice_shape[m], 0, nete, shift, e);
}

ted4_status ted4_prior_load(ted4_prior *p, const float *nete, const uint8_t *shift, ted4_error *e)
{
    ted4_error own = { TED4_OK, 0 };

    load_all(p, NULL, shift, &own);
    if (own.code == TED4_OK)
        load_all(p, nete, shift, &own);
    if (e != NULL && own.code != TED4_OK)
        ted4_fail(e, own.code, own.offset);
    return own.code;
}

/* Rounds n up to whole groups of 32 columns, which dense layers require. */
static size_t group_up(size_t n)
{
    return (n + 31) / 32 * 32;
}

/* Evaluates all layers but the last. Returns their output, which is y, or x if there is only one
 * layer. between is scratch. */
static const int16_t *inner_layers(const ted4_prior *p, const ted4_int_layer *l, unsigned n_layers,
                                   const int16_t *x, size_t n, int16_t *between, int16_t *y)
{
    for (unsigned i = 0; i + 1 < n_layers; i++) {
        /* The outputs alternate so that the last of these layers writes to y. */
        int16_t *to = (n_layers - i) % 2 == 0 ? y : between;

        p->dense->hidden(&l[i], x, n, to);
        x = to;
    }
    return x;
}

static void chain(const ted4_prior *p, const ted4_int_layer *l, unsigned n_layers, const int16_t *x,
                  size_t n, int32_t *out)
{
    _Alignas(64) int16_t hidden[2][TED4_MAX_WIDTH * TED4_PRIOR_BLOCK];

    x = inner_layers(p, l, n_layers, x, n, hidden[0], hidden[1]);
    p->dense->last(&l[n_layers - 1], x, n, out);
}

/* spec 10.1: writes the sines and cosines of octave l for n anchors to two rows, bit for bit as
 * ted4_sine computes them. All table entries are loaded before any is interpolated, so that
 * compilers can vectorise the interpolation. */
static void waves(const uint32_t *phase, unsigned l, size_t n, int16_t *x)
{
    int16_t sine[TED4_PRIOR_BLOCK][2], cosine[TED4_PRIOR_BLOCK][2]; /* a table entry and the next */

    for (size_t i = 0; i < n; i++) {
        const uint32_t at = phase[i] << l >> 22;

        memcpy(sine[i], ted4_sin + at, sizeof sine[i]);
        memcpy(cosine[i], ted4_sin + ((at + 256) & 1023), sizeof cosine[i]);
    }
    for (size_t i = 0; i < n; i++) {
        const int16_t *s = sine[i], *c = cosine[i], b = (int16_t)(phase[i] << l >> 10 & 4095);

        x[i] = ted4_sine_beyond(s[0], (int16_t)(s[1] - s[0]), b);
        x[TED4_PRIOR_BLOCK + i] = ted4_sine_beyond(c[0], (int16_t)(c[1] - c[0]), b);
    }
}

/* Computes the inputs of n anchors, repeating the last one up to a whole group of columns. Returns
 * the number of columns. */
static size_t all_inputs(const ted4_prior *p, const uint16_t *position, size_t n, int16_t *x)
{
    const size_t padded = group_up(n);
    uint32_t phase[3][TED4_PRIOR_BLOCK];

    if (p->n_inputs == 0)
        return padded;
    for (int j = 0; j < 3; j++, x += TED4_PRIOR_BLOCK)
        for (size_t i = 0; i < padded; i++) {
            const int32_t q24 = ted4_half_q24(position[3 * (i < n ? i : n - 1) + (size_t)j]);

            phase[j][i] = (uint32_t)q24 << 7;
            x[i] = (int16_t)ted4_floor_shift(q24, 12);
        }
    for (unsigned l = 0; l < p->pe_octaves; l++)
        for (int j = 0; j < 3; j++, x += 2 * TED4_PRIOR_BLOCK)
            waves(phase[j], l, padded, x);
    return padded;
}

/* spec 10.1 */
void ted4_prior_hyper(const ted4_prior *p, const uint16_t *position, size_t n, int32_t *out)
{
    _Alignas(64) int16_t x[TED4_PRIOR_INPUTS * TED4_PRIOR_BLOCK];

    chain(p, p->hyper, p->n_hyper, x, all_inputs(p, position, n, x), out);
}

const ted4_int_layer *ted4_prior_last(const ted4_prior *p)
{
    return &p->hyper[p->n_hyper - 1];
}

void ted4_prior_hyper_hidden(const ted4_prior *p, const uint16_t *position, size_t n,
                             int16_t *hidden)
{
    _Alignas(64) int16_t x[TED4_PRIOR_INPUTS * TED4_PRIOR_BLOCK],
        between[TED4_MAX_WIDTH * TED4_PRIOR_BLOCK];

    if (p->n_hyper > 1)
        inner_layers(p, p->hyper, p->n_hyper, x, all_inputs(p, position, n, x), between, hidden);
    else
        all_inputs(p, position, n, hidden);
}

void ted4_prior_hyper_some(const ted4_prior *p, const ted4_int_layer *some, const int16_t *hidden,
                           size_t n, int32_t *out)
{
    p->dense->last(some, hidden, group_up(n), out);
}

void ted4_prior_some(const ted4_prior *p, unsigned first, unsigned second, unsigned n,
                     ted4_int_layer *some)
{
    const ted4_int_layer *l = ted4_prior_last(p);

    some->in = l->in;
    some->in_pad = l->in_pad;
    some->out = 2 * n;
    for (unsigned o = 0; o < 2 * n; o++) {
        const unsigned from = o < n ? first + o : second + o - n;

        memcpy(some->w + (size_t)o * l->in_pad, l->w + (size_t)from * l->in_pad,
               l->in_pad * sizeof *l->w);
        some->b[o] = l->b[from];
        some->r[o] = l->r[from];
    }
}

/* spec 10.3 */
void ted4_prior_slice(const ted4_prior *p, unsigned m, const int16_t *ctx, size_t n, int32_t *out)
{
    chain(p, p->slice[m], TED4_SLICE_LAYERS, ctx, group_up(n), out);
}
