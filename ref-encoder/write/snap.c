/* snap.c - see snap.h. The integers are those that ted4_prior_load will compute (spec 7.3).
 * SPDX-License-Identifier: BSD-2-Clause */
#include "write/snap.h"

#include <math.h>
#include <stdlib.h>
#include "norm/prior.h"

enum { MAX_W = 32767 };

/* One output unit: its row of weights and its bias in a blob, and the integers of both. */
typedef struct {
    float *w, *b;
    unsigned in;
    int32_t W[TED4_MAX_WIDTH + 1];
    int64_t B;
    int64_t sum; /* sum of |W| */
} unit;

static float tame(float x)
{
    return isnormal(x) ? x : 0;
}

/* Computes the integers of a unit at a shift, and clamps the weights to 16 bits. Returns 1 if no
 * weight was clamped. */
static int integerise(unit *u, const ted4_unit_rule *rule, int shift)
{
    int whole = 1;

    u->sum = 0;
    for (unsigned i = 0; i < u->in; i++) {
        const int64_t w = ted4_rne_scaled(ted4_float_bits(u->w[i]), shift);

        whole &= w >= -MAX_W && w <= MAX_W;
        u->W[i] = (int32_t)(w < -MAX_W ? -MAX_W : w > MAX_W ? MAX_W : w);
        u->sum += u->W[i] < 0 ? -u->W[i] : u->W[i];
    }
    u->B = ted4_rne_scaled(ted4_float_bits(*u->b), shift + rule->f);
    return whole;
}

/* Reduces a unit until its accumulator is bounded: clamps the bias to half of the range, and scales
 * the weights uniformly so that they fit in the rest. */
static void pull_in(unit *u, const ted4_unit_rule *rule, int shift)
{
    const int64_t half = INT32_MAX / 2;
    int64_t limit;

    if (ted4_accumulator_legal(rule, shift, u->sum, u->B))
        return;
    /* The clamped B must be exact in binary32, which has 24 significant bits. */
    u->B = u->B > half ? half & ~(int64_t)127 : u->B < -half ? -(half & ~(int64_t)127) : u->B;
    limit = (half - ((int64_t)1 << 24)) / rule->amplitude;
    if (u->sum <= limit)
        return;
    for (unsigned i = 0; i < u->in; i++)
        u->W[i] = (int32_t)(u->W[i] * limit / u->sum);
}

static void snap_unit(unit *u, const ted4_unit_rule *rule, int finest, uint8_t *shift)
{
    const int least = rule->g > rule->f ? rule->g - rule->f : 0;
    int s = finest > least ? finest : least;

    for (unsigned i = 0; i < u->in; i++)
        u->w[i] = tame(u->w[i]);
    *u->b = tame(*u->b);
    while (!(integerise(u, rule, s) && ted4_accumulator_legal(rule, s, u->sum, u->B)) && s > least)
        s--;
    pull_in(u, rule, s);
    for (unsigned i = 0; i < u->in; i++)
        u->w[i] = ldexpf((float)u->W[i], -s);
    *u->b = ldexpf((float)u->B, -(s + rule->f));
    *shift = (uint8_t)s;
}

static void snap_net(const ted4_net_shape *n, int hyper, unsigned context_bits, int finest,
                     float *nete, uint8_t *shift)
{
    size_t at = n->first, first_unit = n->first_unit;
    unit u;

    for (unsigned i = 0; i < n->n_layers; i++) {
        const ted4_unit_rule rule = ted4_prior_rule(n, i, hyper, context_bits);
        const unsigned out = n->dim[i + 1];

        u.in = n->dim[i];
        for (unsigned o = 0; o < out; o++) {
            u.w = nete + at + (size_t)o * u.in;
            u.b = nete + at + (size_t)out * u.in + o;
            snap_unit(&u, &rule, finest, shift + first_unit + o);
        }
        at += ((size_t)u.in + 1) * out;
        first_unit += out;
    }
}

void ted4_snap_coarse(const ted4_header *h, const ted4_shape *s, int finest, float *nete,
                      uint8_t *shift)
{
    snap_net(&s->hyper, 1, h->context_bits, finest, nete, shift);
    for (unsigned m = 1; m < h->n_slices; m++)
        snap_net(&s->slice[m], 0, h->context_bits, finest, nete, shift);
}

void ted4_snap(const ted4_header *h, const ted4_shape *s, float *nete, uint8_t *shift)
{
    ted4_snap_coarse(h, s, TED4_MAX_SHIFT, nete, shift);
}

typedef struct {
    uint64_t code;
    uint32_t index;
} key;

static int compare(const void *a, const void *b)
{
    const key *x = a, *y = b;

    if (x->code != y->code)
        return x->code < y->code ? -1 : 1;
    return x->index < y->index ? -1 : x->index > y->index;
}

size_t ted4_positions_sort(const uint16_t *position, size_t n, uint32_t *order)
{
    key *keys = malloc((n + 1) * sizeof *keys);
    size_t kept = 0;

    if (keys == NULL)
        return SIZE_MAX;
    for (size_t i = 0; i < n; i++)
        keys[i] = (key) { ted4_morton(position + 3 * i), (uint32_t)i };
    qsort(keys, n, sizeof *keys, compare);
    for (size_t i = 0; i < n; i++)
        if (i == 0 || keys[i].code != keys[i - 1].code)
            order[kept++] = keys[i].index;
    free(keys);
    return kept;
}
