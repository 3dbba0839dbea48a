/* compact_weights.c - see compact.h. The weights of a unit are integers times a power of two: the
 * unit's shift in NETE, and otherwise the largest one of which all are multiples, at one byte a
 * unit. A weight is expected to be as long as the two before it were.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <math.h>
#include <stdlib.h>
#include "compact.h"
#include "compact_counter.h"
#include "norm/coded_weights.h"
#include "norm/prior.h"
#include "write/deflate.h"

typedef struct {
    compact_counter counter;
    ted4_integer_model model;
} weight_coder;

static void begin(weight_coder *w)
{
    w->counter = (compact_counter) { .base = { .ops = &compact_counter_ops } };
    ted4_integer_model_init(&w->model);
}

/* The exponent of the lowest bit that is set in any of x[n]; 0 if all are zero. */
static int grid_of(const float *x, size_t n, double *most)
{
    int lowest = 0, any = 0;

    *most = 0;
    for (size_t i = 0; i < n; i++) {
        int e;
        double m = frexp((double)x[i], &e);

        if (m == 0)
            continue;
        *most = fmax(*most, fabs((double)x[i]));
        for (e -= 24, m = ldexp(m, 24); fmod(m, 2) == 0; m /= 2)
            e++;
        lowest = any && lowest < e ? lowest : e;
        any = 1;
    }
    return lowest;
}

/* A unit with larger integers than the coder has stays binary32. */
static void code_unit(weight_coder *w, float *x, size_t n)
{
    double most;
    const int e = grid_of(x, n, &most);

    w->counter.bits += 8;
    if (ldexp(most, -e) < ldexp(1, TED4_WEIGHT_BITS))
        ted4_code_weights(&w->counter.base, &w->model, e, x, n);
    else
        w->counter.bits += 32.0 * (double)n;
}

static double nete_bits(const ted4_scene *s, const ted4_net_shape *n, int hyper)
{
    float *x = s->nete.values + n->first;
    const uint8_t *shift = s->shift + n->first_unit;
    double bits = 0;

    for (unsigned i = 0; i < n->n_layers; i++) {
        const ted4_unit_rule rule = ted4_prior_rule(n, i, hyper, s->head.context_bits);
        const unsigned in = n->dim[i], out = n->dim[i + 1];
        weight_coder w, b;

        begin(&w);
        begin(&b);
        for (unsigned o = 0; o < out; o++) {
            ted4_code_weights(&w.counter.base, &w.model, -shift[o], x + (size_t)o * in, in);
            ted4_code_weights(&b.counter.base, &b.model, -(shift[o] + rule.f),
                              x + (size_t)out * in + o, 1);
        }
        bits += w.counter.bits + b.counter.bits;
        x += ted4_layer_size(n, i);
        shift += out;
    }
    return bits;
}

double compact_nete(const ted4_scene *s)
{
    double bits = nete_bits(s, &s->shape.hyper, 1);

    for (unsigned m = 1; m < s->head.n_slices; m++)
        bits += nete_bits(s, &s->shape.slice[m], 0);
    return bits + 8.0 * (double)s->shape.n_units;
}

double compact_netr(const ted4_scene *s)
{
    double bits = 0;

    for (int net = 0; net < TED4_NETS_R; net++) {
        const ted4_net_shape *const n = &s->shape.netr[net];
        float *x = s->netr.values + n->first;

        for (unsigned i = 0; i < n->n_layers; i++) {
            const size_t in = n->dim[i], out = n->dim[i + 1];
            weight_coder w;

            begin(&w);
            for (size_t o = 0; o < out; o++)
                code_unit(&w, x + o * in, in);
            code_unit(&w, x + out * in, out);
            bits += w.counter.bits;
            x += (in + 1) * out;
        }
    }
    return bits;
}

double compact_bank(const ted4_scene *s)
{
    weight_coder w;

    begin(&w);
    code_unit(&w, s->bank.values, s->bank.n);
    return w.counter.bits;
}

double compact_deflated(const ted4_blob *b)
{
    uint8_t *const work = compact_need(4 * b->n, 1);
    uint8_t *const packed = compact_need(ted4_deflate_bound(b->n), 1);
    size_t size = 4 * b->n;

    if (b->n > 0 && !ted4_deflate(b->values, b->n, work, packed, &size))
        size = 4 * b->n;
    free(work);
    free(packed);
    return 8.0 * (double)size;
}
