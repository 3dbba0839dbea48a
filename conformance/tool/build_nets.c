/* build_nets.c - builds the networks and the bank of a scene. Weights of Tier E are given as the
 * integers that the decoder will compute (spec 7.3).
 *     nete random | zero                   all networks of Tier E; random is the default
 *     unit NET LAYER OUT shift S [bias B] [all W | w W0 W1 ...]     one output unit; NET: hyper,
 *         slice1, slice2, ...
 *     out TYPE COMPS mu|g|q|s|v VALUE[:STEP] [W0 W1 W2 ...]     last layer of the hyperprior: mu in
 *         Q8, sigma index, step index, or
 *                                          the outputs s and v themselves. Each is VALUE plus STEP
 *                                          times the component. The weights have shift 0; without
 *                                          any they are 0. COMPS: *, 3 or 3-7
 *     netr | bank random | zero | const X
 *     value nete | netr | bank INDEX X ... single values, from INDEX on
 * SPDX-License-Identifier: BSD-2-Clause */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "build.h"
#include "norm/prior.h"

/* The values and shifts of a layer. */
typedef struct {
    float *w, *b;   /* [out][in], [out] */
    uint8_t *shift; /* [out] */
    unsigned in, out;
    ted4_unit_rule rule;
} layer;

static layer layer_of(const conf_build *b, unsigned m, unsigned number)
{
    const ted4_shape *s = &b->scene->shape;
    const ted4_net_shape *n = m == 0 ? &s->hyper : &s->slice[m];
    size_t at = n->first, unit = n->first_unit;
    layer l;

    for (unsigned i = 0; i < number; i++) {
        at += ted4_layer_size(n, (unsigned)i);
        unit += n->dim[i + 1];
    }
    l.in = n->dim[number];
    l.out = n->dim[number + 1];
    l.w = b->scene->nete.values + at;
    l.b = l.w + (size_t)l.in * l.out;
    l.shift = b->scene->shift + unit;
    l.rule = ted4_prior_rule(n, number, m == 0, b->head.context_bits);
    return l;
}

static unsigned layers_of(const conf_build *b, unsigned m)
{
    return m == 0 ? b->scene->shape.hyper.n_layers : b->scene->shape.slice[m].n_layers;
}

static int least_shift(const layer *l)
{
    return l->rule.g > l->rule.f ? l->rule.g - l->rule.f : 0;
}

static void put_w(const layer *l, unsigned o, unsigned i, long long w)
{
    l->w[(size_t)o * l->in + i] = ldexpf((float)w, -l->shift[o]);
}

static void put_b(const layer *l, unsigned o, long long v)
{
    l->b[o] = ldexpf((float)v, -(l->shift[o] + l->rule.f));
}

static int root(int x)
{
    int r = 1;

    while ((r + 1) * (r + 1) <= x)
        r++;
    return r;
}

/* Draws moderate weights. Last layers give mu within a few steps and sigma around one step. */
static void random_layer(conf_build *b, const layer *l, int last)
{
    for (unsigned o = 0; o < l->out; o++) {
        const int shift = least_shift(l) + conf_in(&b->chance, 6, 9),
                  bound = (1 << 30) / l->rule.amplitude / ((int)l->in + 1);
        const int target = (1 << shift) / root((int)l->in + 1),
                  most = target < bound ? target : bound;

        l->shift[o] = (uint8_t)shift;
        for (unsigned i = 0; i < l->in; i++)
            put_w(l, o, i, conf_in(&b->chance, -most, most));
        put_b(l, o,
              conf_in(&b->chance, -(1 << (shift + l->rule.f)), 1 << (shift + l->rule.f)) /
                  (last ? 1 : 4));
    }
}

static void random_nete(conf_build *b)
{
    for (unsigned m = 0; m < b->head.n_slices; m++)
        for (unsigned i = 0; i < layers_of(b, m); i++) {
            const layer l = layer_of(b, m, i);

            random_layer(b, &l, i + 1 == layers_of(b, m));
        }
}

static void zero_nete(conf_build *b)
{
    memset(b->scene->nete.values, 0, (size_t)b->scene->nete.n * sizeof(float));
    for (unsigned m = 0; m < b->head.n_slices; m++)
        for (unsigned i = 0; i < layers_of(b, m); i++) {
            const layer l = layer_of(b, m, i);

            memset(l.shift, least_shift(&l), l.out);
        }
}

/* Parses W0 W1 ... up to the end of the line. A,B*N stands for N repetitions of A B. */
static void weights(const conf_line *line, int i, const layer *l, unsigned o)
{
    unsigned j = 0;

    for (; i < line->n; i++) {
        const char *const star = strchr(line->word[i], '*');

        for (long n = star != NULL ? strtol(star + 1, NULL, 10) : 1; n > 0; n--)
            for (char *p = line->word[i]; *p != '\0' && *p != '*' && j < l->in; p += *p == ',')
                put_w(l, o, j++, strtol(p, &p, 10));
    }
}

/* Returns the layer of words i, i + 1, i + 2: network, layer, unit. */
static layer named_unit(const conf_build *b, const conf_line *line, int i, unsigned *unit)
{
    const unsigned m =
        conf_word_is(line, i, "hyper") ? 0 : (unsigned)strtoul(line->word[i] + 5, NULL, 10);
    layer l;

    if (m >= b->head.n_slices)
        conf_line_bad(line, "no such network");
    l = layer_of(b, m, (unsigned)conf_line_number(line, i + 1, 0, layers_of(b, m) - 1));
    *unit = (unsigned)conf_line_number(line, i + 2, 0, l.out - 1);
    return l;
}

size_t conf_bias_index(const conf_build *b, const conf_line *l, int i, int *scale)
{
    unsigned unit;
    const layer named = named_unit(b, l, i, &unit);

    *scale = named.shift[unit] + named.rule.f;
    return (size_t)(named.b + unit - b->scene->nete.values);
}

static void unit_line(conf_build *b, const conf_line *line)
{
    unsigned o;
    const layer l = named_unit(b, line, 1, &o);

    for (unsigned i = 0; i < l.in; i++)
        put_w(&l, o, i, 0);
    put_b(&l, o, 0);
    for (int i = 4; i < line->n; i += 2) {
        if (conf_word_is(line, i, "shift")) {
            l.shift[o] = (uint8_t)conf_line_number(line, i + 1, 0, 20);
        } else if (conf_word_is(line, i, "bias")) {
            put_b(&l, o, conf_line_number(line, i + 1, -(1LL << 40), 1LL << 40));
        } else if (conf_word_is(line, i, "all")) {
            for (unsigned j = 0; j < l.in; j++)
                put_w(&l, o, j, conf_line_number(line, i + 1, -(1 << 24), 1 << 24));
        } else if (conf_word_is(line, i, "w")) {
            weights(line, i + 1, &l, o);
            break;
        } else {
            conf_line_bad(line, "neither shift, bias, all nor w");
        }
    }
}

/* Parses "*", "3" or "3-7". */
static void components(const conf_line *l, int i, unsigned dim, unsigned *first, unsigned *end)
{
    char *rest;

    *first = 0;
    *end = dim;
    if (conf_word_is(l, i, "*"))
        return;
    *first = (unsigned)strtoul(l->word[i], &rest, 10);
    *end = *rest == '-' ? (unsigned)strtoul(rest + 1, NULL, 10) + 1 : *first + 1;
    if (*end > dim || *first >= *end)
        conf_line_bad(l, "no such component");
}

static void out_line(conf_build *b, const conf_line *line)
{
    const ted4_shape *s = &b->scene->shape;
    const int type = conf_word_type(line, 1);
    const layer l = layer_of(b, 0, layers_of(b, 0) - 1u);
    const char *const step = strchr(line->word[4], ':');
    const long value = strtol(line->word[4], NULL, 10),
               by = step != NULL ? strtol(step + 1, NULL, 10) : 0;
    unsigned first, end, at = s->first_output[type];

    if (s->dim[type] == 0)
        conf_line_bad(line, "the type is absent");
    components(line, 2, s->dim[type], &first, &end);
    if (conf_word_is(line, 3, "g") || conf_word_is(line, 3, "s"))
        at += s->dim[type];
    if (conf_word_is(line, 3, "q") || conf_word_is(line, 3, "v")) {
        at = s->first_step_output;
        for (int t = 0; t < type; t++)
            at += s->dim[t] > 0;
        first = 0;
        end = 1;
    }
    for (unsigned c = first; c < end; c++) {
        const unsigned o = at + c;
        const long long v = value + by * (long)c;
        const long long y = conf_word_is(line, 3, "g")   ? 16 * (v - 64)
                            : conf_word_is(line, 3, "q") ? 8 * (v - 128)
                                                         : v;

        l.shift[o] = 0;
        for (unsigned i = 0; i < l.in; i++)
            put_w(&l, o, i,
                  5 + (int)i < line->n ? conf_line_number(line, 5 + (int)i, -32767, 32767) : 0);
        put_b(&l, o, y * (1LL << (l.rule.f - l.rule.g)));
    }
}

static void random_blob(conf_build *b, ted4_blob *blob)
{
    for (size_t i = 0; i < blob->n; i++)
        blob->values[i] = (float)conf_in(&b->chance, -256, 256) / 256;
}

static void blob_line(conf_build *b, const conf_line *l, ted4_blob *blob)
{
    for (size_t i = 0; i < blob->n; i++)
        blob->values[i] = conf_word_is(l, 1, "zero") ? 0
                          : conf_word_is(l, 1, "const")
                              ? conf_word_float(l, 2)
                              : (float)conf_in(&b->chance, -256, 256) / 256;
}

static ted4_blob *blob_of(conf_build *b, const conf_line *l, int i)
{
    return conf_word_is(l, i, "nete")   ? &b->scene->nete
           : conf_word_is(l, i, "netr") ? &b->scene->netr
           : conf_word_is(l, i, "bank") ? &b->scene->bank
                                        : NULL;
}

static void value_line(conf_build *b, const conf_line *l)
{
    ted4_blob *const blob = blob_of(b, l, 1);
    size_t at;

    if (blob == NULL)
        conf_line_bad(l, "no blob");
    at = (size_t)conf_line_number(l, 2, 0, (long long)blob->n - 1);
    for (int i = 3; i < l->n && at < blob->n; i++, at++)
        blob->values[at] = conf_word_float(l, i);
}

void conf_build_nets(conf_build *b)
{
    random_nete(b);
    random_blob(b, &b->scene->netr);
    random_blob(b, &b->scene->bank);
    for (size_t i = 0; i < b->recipe->n; i++) {
        const conf_line *const l = &b->recipe->line[i];

        if (conf_word_is(l, 0, "nete") && conf_word_is(l, 1, "zero"))
            zero_nete(b);
        else if (conf_word_is(l, 0, "unit"))
            unit_line(b, l);
        else if (conf_word_is(l, 0, "out"))
            out_line(b, l);
        else if (conf_word_is(l, 0, "netr") || conf_word_is(l, 0, "bank"))
            blob_line(b, l, blob_of(b, l, 0));
        else if (conf_word_is(l, 0, "value"))
            value_line(b, l);
    }
}
