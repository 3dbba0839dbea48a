/* rate_check.c - what the integers of Tier E cost: the attribute symbols of a file coded by rANS, by -log2 of the coded integer
 * frequencies, and by a float64 evaluation of the same networks and the same Gaussian model (spec 7.1, 9.4, 10). Used by `make rate-check`.
 *     rate_check FILE.ted4            one JSON line on stdout
 *     rate_check FILE.ted4 -s ANCHOR  also mu, sigma and k of that anchor's symbols under both, on stderr
 * float64: weights as the file stores them, sine and cosine of the exact position, contexts k STEP[Qi], no rounding and no saturation in
 * hidden layers, mu and sigma real numbers, the step index as decoded, Phi differences over the unit bin without cancellation. Sigma keeps
 * to the range of the table of spec 9.4, which belongs to the model. A symbol coded by an escape counts at what it costs in the integer
 * coder in every column. A bare Gaussian pays more than 16 bits for a symbol beyond 4 sigma, the coder never does, as every symbol of its
 * alphabet owns a slot: so "float64" can come out above the integers. "float64_floored" gives its symbols that slot too,
 * P (1 - R / 2^16) + 2^-16, and so shows the rounding alone.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "kernel/int_kernel.h"
#include "norm/gaussian.h"
#include "norm/half.h"
#include "norm/scene.h"
#include "write/encode.h"
#include "write/gauss_put.h"

enum { BLOCK = TED4_PRIOR_BLOCK, SUBSTREAMS = 24 };

#define SQRT_HALF 0.70710678118654752440
#define LOG2_E    1.44269504088896340736
#define PI        3.14159265358979323846

typedef struct {
    uint64_t coded_bytes, symbols, escapes;
    double   integer, real, floored, escaped;       /* bits; escaped: the part of escapes */
} cost;

typedef struct {
    ted4_scene *s;
    ted4_prior  prior;
    uint64_t    substream[SUBSTREAMS];      /* bytes, all tiles */
    int64_t     shown;                      /* anchor of -s, or -1 */
    cost        cost[TED4_TYPES];
    int32_t    *out, *added;                /* [P][64], [2 max slice][64] integer outputs */
    int16_t    *ctx;                        /* [F][64] */
    double     *y, *hidden[2], *x;          /* outputs [P], layers, inputs of one anchor in float64 */
} check;

/* ---- float64 ---- */

/* spec 7.1 in doubles; all layers but the last are followed by ReLU. */
static void real_net(const check *c, const ted4_net_shape *n, const double *x, double *y)
{
    const float *v = c->s->nete.values + n->first;

    for (unsigned i = 0; i < n->n_layers; i++) {
        const unsigned in = n->dim[i], out = n->dim[i + 1];
        const int      last = i + 1u == n->n_layers;
        double        *to = last ? y : c->hidden[i % 2];

        for (unsigned o = 0; o < out; o++) {
            double sum = v[(size_t)in * out + o];

            for (unsigned j = 0; j < in; j++)
                sum += (double)v[(size_t)o * in + j] * x[j];
            to[o] = last || sum > 0 ? sum : 0;
        }
        v += ((size_t)in + 1) * out;
        x = to;
    }
}

/* spec 10.1: the phase of octave l is p 2^(l - 1) turns, exact in a double. */
static void real_inputs(const check *c, size_t a, double *x)
{
    double p[3];

    for (int j = 0; j < 3; j++)
        *x++ = p[j] = ldexp(ted4_half_q24(c->s->position[3 * a + (size_t)j]), -24);
    for (int l = 0; l < c->s->head.pe_octaves; l++)
        for (int j = 0; j < 3; j++) {
            const double turns = ldexp(p[j], l - 1);
            const double angle = 2 * PI * (turns - rint(turns));

            *x++ = sin(angle);
            *x++ = cos(angle);
        }
}

/* All mu and log2 sigma of an anchor into c->y, in steps, the slice networks added. */
static void real_model(const check *c, size_t a)
{
    const ted4_scene *s = c->s;
    const size_t n = s->head.n_anchors;
    unsigned     comp = s->head.slice[0];

    if (s->head.prior == TED4_PRIOR_INR)
        real_inputs(c, a, c->x);
    real_net(c, &s->shape.hyper, c->x, c->y);
    for (unsigned i = 0; i < s->head.feature_dim; i++)
        c->x[i] = s->symbol[TED4_FEATURE][i * n + a]
                * (double)ted4_bits_float(ted4_step[s->step_index[TED4_FEATURE][a]]);
    for (unsigned m = 1; m < s->head.n_slices; comp += s->head.slice[m++]) {
        const unsigned dim = s->head.slice[m];
        double         add[2 * TED4_MAX_FEATURE];

        real_net(c, &s->shape.slice[m], c->x, add);
        for (unsigned i = 0; i < dim; i++) {
            c->y[comp + i] += add[i];
            c->y[s->head.feature_dim + comp + i] += add[dim + i];
        }
    }
}

/* -log2 of slot + (1 - slots_all) mass, the mass being that of a Gaussian on [d - 1/2, d + 1/2], d = k - mu. By symmetry d >= 0, so
 * both ends lie in the upper tail, or the mass is 1 less two tails. */
static double real_bits(double d, double sigma, double slot, double slots_all)
{
    const double a = (fabs(d) - 0.5) / sigma * SQRT_HALF, b = (fabs(d) + 0.5) / sigma * SQRT_HALF;

    if (a < 0)
        return -LOG2_E * log1p(slot - slots_all - (1 - slots_all) * 0.5 * (erfc(-a) + erfc(b)));
    return -log2(fmax(slot + (1 - slots_all) * 0.5 * (erfc(a) - erfc(b)), 1e-300));
}

/* ---- integers ---- */

static void add_slots(void *bits, ted4_slots s)
{
    *(double *)bits += TED4_SLOT_BITS - log2(s.freq);
}

/* One symbol, whose integer model is mu, g and whose float64 one is y, log_sigma. */
static void add_symbol(check *c, int type, unsigned comp, size_t a, int32_t mu, unsigned g,
                       double y, double log_sigma)
{
    cost        *t = &c->cost[type];
    const int    k = c->s->symbol[type][(size_t)comp * c->s->head.n_anchors + a];
    const double low = -4, high = (TED4_N_SIGMA - 1 - 64) / 16.0;
    const double slot = 0x1p-16;
    double       bits = 0, real, floored;

    (void)ted4_gauss_put(mu, g, k, add_slots, &bits);
    t->symbols++;
    t->integer += bits;
    if (ted4_gauss_of(mu, g, k).escape >= 0) {
        t->escapes++;
        t->escaped += bits;
        real = floored = bits;
    } else {
        const double sigma = exp2(fmin(fmax(log_sigma, low), high));

        real = real_bits(k - y, sigma, 0, 0);
        floored = real_bits(k - y, sigma, slot, slot * ted4_gauss_size(g));
    }
    t->real += real;
    t->floored += floored;
    if ((int64_t)a == c->shown)
        fprintf(stderr, "type %d component %u k %d: integer mu %.9g log2 sigma %.4f bits %.6f; float64 mu %.9g "
                "log2 sigma %.9g bits %.6f\n", type, comp, k, mu / 256.0, (g - 64.0) / 16, bits, y, log_sigma, real);
}

static int coded(const ted4_scene *s, int type, unsigned comp, size_t a)
{
    return type == TED4_PHI ? s->dynamic[a]
         : type == TED4_OFFSET ? s->offset_bits[a] >> comp / 3 & 1 : 1;
}

/* Integer outputs of n <= 64 anchors from first on, the slice networks added. */
static void integer_model(check *c, size_t first, size_t n)
{
    const ted4_scene  *s = c->s;
    const ted4_header *h = &s->head;
    unsigned           comp = h->slice[0];

    ted4_prior_hyper(&c->prior, s->position + 3 * first, n, c->out);
    for (unsigned i = 0; i < h->feature_dim; i++)
        for (size_t a = 0; a < n; a++)
            c->ctx[i * BLOCK + a] = ted4_context(s->symbol[TED4_FEATURE][(size_t)i * h->n_anchors + first + a],
                                                 s->step_index[TED4_FEATURE][first + a], h->context_bits);
    for (unsigned m = 1; m < h->n_slices; comp += h->slice[m++]) {
        const size_t part = (size_t)h->slice[m] * BLOCK;
        int32_t     *mu = c->out + (size_t)comp * BLOCK, *sigma = mu + (size_t)h->feature_dim * BLOCK;

        ted4_prior_slice(&c->prior, m, c->ctx, n, c->added);
        for (size_t i = 0; i < part; i++) {
            if (i % BLOCK >= n)
                continue;
            mu[i] += c->added[i];
            sigma[i] += c->added[part + i];
        }
    }
}

static void add_block(check *c, size_t first, size_t n)
{
    const ted4_shape *shape = &c->s->shape;

    integer_model(c, first, n);
    for (size_t a = 0; a < n; a++) {
        real_model(c, first + a);
        for (int t = 0; t < TED4_TYPES; t++)
            for (unsigned i = 0; i < shape->dim[t]; i++) {
                const size_t at = shape->first_output[t] + i, sigma = at + shape->dim[t];

                if (coded(c->s, t, i, first + a))
                    add_symbol(c, t, i, first + a, c->out[at * BLOCK + a],
                               ted4_sigma_index(c->out[sigma * BLOCK + a]), c->y[at], c->y[sigma]);
            }
    }
}

/* ---- the file ---- */

static void keep_sizes(void *arg, size_t offset, const char *element, int64_t index, int64_t value)
{
    check *c = arg;

    (void)offset;
    if (strcmp(element, "size") == 0)
        c->substream[index] += (uint64_t)value;
}

/* Substreams in order of spec 9.1, the masks first. */
static void sort_sizes(check *c)
{
    const ted4_header *h = &c->s->head;
    unsigned           at = h->temporal_mask || h->offset_mask;

    for (unsigned m = 0; m < h->n_slices; m++)
        c->cost[TED4_FEATURE].coded_bytes += c->substream[at++];
    for (int t = TED4_SCALING; t < TED4_TYPES; t++)
        if (c->s->shape.dim[t] > 0)
            c->cost[t].coded_bytes += c->substream[at++];
}

static uint8_t *read_all(const char *path, size_t *size)
{
    FILE    *f = fopen(path, "rb");
    uint8_t *data = NULL;
    long     n;

    if (f == NULL)
        return NULL;
    if (fseek(f, 0, SEEK_END) == 0 && (n = ftell(f)) >= 0 && fseek(f, 0, SEEK_SET) == 0) {
        *size = (size_t)n;
        data = malloc(*size + 1);
        if (data != NULL && fread(data, 1, *size, f) != *size) {
            free(data);
            data = NULL;
        }
    }
    fclose(f);
    return data;
}

static void *need(ted4_arena *a, size_t n, size_t size)
{
    void *p = ted4_arena_alloc(a, n, size);

    if (p == NULL) {
        fprintf(stderr, "rate_check: out of memory\n");
        exit(3);
    }
    return p;
}

static void prepare(check *c, ted4_arena *a)
{
    const ted4_shape *shape = &c->s->shape;

    ted4_arena_init(a, NULL);
    if (ted4_prior_init(&c->prior, &c->s->head, shape, a) != TED4_OK
        || ted4_prior_load(&c->prior, c->s->nete.values, c->s->shift, NULL) != TED4_OK) {
        fprintf(stderr, "rate_check: networks cannot be loaded\n");
        exit(3);
    }
    c->prior.dense = ted4_select_int_dense();
    c->out = need(a, (size_t)shape->n_outputs * BLOCK, sizeof *c->out);
    c->added = need(a, 2 * TED4_MAX_FEATURE * BLOCK, sizeof *c->added);
    c->ctx = need(a, TED4_MAX_FEATURE * BLOCK, sizeof *c->ctx);
    c->y = need(a, shape->n_outputs, sizeof *c->y);
    c->x = need(a, TED4_PRIOR_INPUTS + TED4_MAX_FEATURE, sizeof *c->x);
    for (int i = 0; i < 2; i++)
        c->hidden[i] = need(a, TED4_MAX_WIDTH, sizeof *c->hidden[i]);
}

/* How much a is above b. */
static double percent(double a, double b)
{
    return b > 0 ? 100 * (a / b - 1) : 0;
}

static void print_cost(const char *name, const cost *c)
{
    const double coded_bits = 8.0 * (double)c->coded_bytes;

    printf("\"%s\":{\"symbols\":%" PRIu64 ",\"escapes\":%" PRIu64 ",\"escape_bits\":%.1f,\"coded_bits\":%.0f,"
           "\"integer_bits\":%.1f,\"float64_bits\":%.1f,\"float64_floored_bits\":%.1f,"
           "\"integer_over_float64_percent\":%.4f,\"integer_over_floored_percent\":%.4f,\"rans_over_integer_percent\":%.4f}",
           name, c->symbols, c->escapes, c->escaped, coded_bits, c->integer, c->real, c->floored,
           percent(c->integer, c->real), percent(c->integer, c->floored), percent(coded_bits, c->integer));
}

/* One line of JSON. 0, or 1: the integer frequencies met here are not those of ted4_count. */
static int print_result(const check *c, const char *path, const ted4_bits *counted)
{
    static const char *const name[TED4_TYPES] = { "feature", "scaling", "offset", "phi", "tau" };
    cost total = { 0, 0, 0, 0, 0, 0, 0 };
    int  bad = 0;

    printf("{\"file\":\"%s\",\"anchors\":%" PRIu32 ",", path, c->s->head.n_anchors);
    for (int t = 0; t < TED4_TYPES; t++) {
        const cost *x = &c->cost[t];

        bad |= fabs(x->integer - counted->type[t]) > 1e-7 * counted->type[t];
        total.coded_bytes += x->coded_bytes;
        total.symbols += x->symbols;
        total.escapes += x->escapes;
        total.escaped += x->escaped;
        total.integer += x->integer;
        total.real += x->real;
        total.floored += x->floored;
        if (c->s->shape.dim[t] > 0) {
            print_cost(name[t], x);
            putchar(',');
        }
    }
    print_cost("total", &total);
    puts("}");
    if (bad)
        fprintf(stderr, "rate_check: integer bits differ from those of ted4_count\n");
    return bad;
}

int main(int argc, char **argv)
{
    static check  c = { .shown = -1 };
    const ted4_options o = { .trace = keep_sizes, .trace_user = &c };
    ted4_error    e = { TED4_OK, 0 };
    ted4_arena    arena;
    ted4_bits     counted;
    size_t        size = 0;
    uint8_t      *data = argc > 1 ? read_all(argv[1], &size) : NULL;

    if (data == NULL || (argc != 2 && (argc != 4 || strcmp(argv[2], "-s") != 0))) {
        fprintf(stderr, "rate_check: usage: rate_check FILE.ted4 [-s ANCHOR]\n");
        return 3;
    }
    if (ted4_decode(data, size, &o, &c.s, &e) != TED4_OK || ted4_count(c.s, NULL, &counted, &e) != TED4_OK) {
        fprintf(stderr, "rate_check: %s: byte %zu: %s\n", argv[1], e.offset, ted4_status_id(e.code));
        return 1;
    }
    if (argc == 4)
        c.shown = atoll(argv[3]);
    prepare(&c, &arena);
    sort_sizes(&c);
    for (size_t a = 0; a < c.s->head.n_anchors; a += BLOCK)
        add_block(&c, a, c.s->head.n_anchors - a < BLOCK ? c.s->head.n_anchors - a : BLOCK);

    const int bad = print_result(&c, argv[1], &counted);

    ted4_arena_finish(&arena);
    ted4_scene_free(c.s);
    free(data);
    return bad;
}
