/* rate_check.c - measures the cost of the integer arithmetic of Tier E. The attribute symbols of a
 * file are coded by rANS, by -log2 of the coded integer frequencies, and by float64 and float32
 * evaluations of the same networks and the same Gaussian model (spec 7.1, 9.4, 10). Also measures
 * how long the networks take in each precision, on one thread, with the vectors of this machine.
 *     rate_check FILE.ted4            one JSON line on stdout
 *     rate_check FILE.ted4 -s ANCHOR  also mu, sigma and k of that anchor's symbols under both, on
 *                                     stderr
 * float64: the networks of rate_real.h, mu and sigma as real numbers, the step index as decoded,
 * and differences of Phi over the unit bin without cancellation. Sigma is clamped to the range of
 * the table of spec 9.4, because the table belongs to the model. In every column, a symbol coded by
 * an escape counts with its cost in the integer coder. A plain Gaussian spends more than 16 bits on
 * a symbol beyond 4 sigma. The coder never does, because every symbol of its alphabet owns a slot,
 * so that "float64" can exceed the integers. "float64_floored" also gives each of its symbols that
 * slot, P (1 - R / 2^16) + 2^-16, and thus shows the effect of rounding alone; "float32_floored" is
 * the same with mu and sigma from float32 networks.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include "kernel/int_kernel.h"
#include "norm/gaussian.h"
#include "norm/half.h"
#include "norm/scene.h"
#include "tool/cli.h"
#include "write/encode.h"
#include "write/gauss_put.h"

#if defined(__AVX512F__)
enum { VECTOR = 64 }; /* bytes */
#elif defined(__AVX__)
enum { VECTOR = 32 };
#else
enum { VECTOR = 16 };
#endif

enum { BLOCK = TED4_PRIOR_BLOCK, SUBSTREAMS = 24 };

#define SQRT_HALF 0.70710678118654752440
#define LOG2_E    1.44269504088896340736
#define PI        3.14159265358979323846

#define REAL    double
#define NAME(x) double_##x
#define SIN     sin
#define COS     cos
#include "rate_real.h"
#define REAL    float
#define NAME(x) float_##x
#define SIN     sinf
#define COS     cosf
#include "rate_real.h"

typedef struct {
    uint64_t coded_bytes, symbols, escapes;
    double integer, real, floored, floored32, escaped; /* bits; escaped: the part of escapes */
} cost;

/* The model of one symbol in each precision: mu in units of the step, and log2 sigma. */
typedef struct {
    int32_t mu; /* the integers of spec 10 */
    unsigned sigma;
    double real_mu, real_sigma, float_mu, float_sigma;
} models;

typedef struct {
    ted4_scene *s;
    ted4_prior prior;
    uint64_t substream[SUBSTREAMS]; /* bytes, all tiles */
    int64_t shown;                  /* the anchor of -s, or -1 */
    cost cost[TED4_TYPES];
    int32_t *out, *added;           /* [P][64], [2 max slice][64] integer outputs */
    int16_t *ctx;                   /* [F][64] */
    double *y, *hidden[2], *x;      /* [P][64], layers, inputs in float64 */
    float *y32, *hidden32[2], *x32; /* the same in float32 */
    double ms[3];                   /* time of the networks: integer, float32, float64 */
} check;

/* ---- floating point ---- */

/* Returns -log2 of slot + (1 - slots_all) mass, where mass is that of a Gaussian on [d - 1/2, d +
 * 1/2] and d = k - mu. By symmetry d >= 0, so that both ends lie in the upper tail, or the mass is
 * 1 minus two tails. */
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

/* Returns 2^x, clamped to the range of the table of spec 9.4. */
static double sigma_in_range(double x)
{
    return exp2(fmin(fmax(x, -4), (TED4_N_SIGMA - 1 - 64) / 16.0));
}

static void add_symbol(check *c, int type, unsigned comp, size_t a, const models *m)
{
    cost *t = &c->cost[type];
    const int k = c->s->symbol[type][(size_t)comp * c->s->head.n_anchors + a];
    const double slot = 0x1p-16, slots = slot * ted4_gauss_size(m->sigma);
    double bits = 0, real, floored, floored32;

    (void)ted4_gauss_put(m->mu, m->sigma, k, add_slots, &bits);
    t->symbols++;
    t->integer += bits;
    if (ted4_gauss_of(m->mu, m->sigma, k).escape >= 0) {
        t->escapes++;
        t->escaped += bits;
        real = floored = floored32 = bits;
    } else {
        const double sigma = sigma_in_range(m->real_sigma);

        real = real_bits(k - m->real_mu, sigma, 0, 0);
        floored = real_bits(k - m->real_mu, sigma, slot, slots);
        floored32 = real_bits(k - m->float_mu, sigma_in_range(m->float_sigma), slot, slots);
    }
    t->real += real;
    t->floored += floored;
    t->floored32 += floored32;
    if ((int64_t)a == c->shown)
        fprintf(
            stderr,
            "type %d component %u k %d: integer mu %.9g log2 sigma %.4f bits %.6f; float64 mu %.9g "
            "log2 sigma %.9g bits %.6f\n",
            type, comp, k, m->mu / 256.0, (m->sigma - 64.0) / 16, bits, m->real_mu, m->real_sigma,
            real);
}

static int coded(const ted4_scene *s, int type, unsigned comp, size_t a)
{
    return type == TED4_PHI      ? s->dynamic[a]
           : type == TED4_OFFSET ? s->offset_bits[a] >> comp / 3 & 1
                                 : 1;
}

/* Computes the integer outputs of n <= 64 anchors, beginning at anchor first, with the slice
 * networks added. */
static void integer_model(check *c, size_t first, size_t n)
{
    const ted4_scene *s = c->s;
    const ted4_header *h = &s->head;
    unsigned comp = h->slice[0];

    ted4_prior_hyper(&c->prior, s->position + 3 * first, n, c->out);
    for (unsigned i = 0; i < h->feature_dim; i++)
        for (size_t a = 0; a < n; a++)
            c->ctx[i * BLOCK + a] =
                ted4_context(s->symbol[TED4_FEATURE][(size_t)i * h->n_anchors + first + a],
                             s->step_index[TED4_FEATURE][first + a], h->context_bits);
    for (unsigned m = 1; m < h->n_slices; comp += h->slice[m++]) {
        const size_t part = (size_t)h->slice[m] * BLOCK;
        int32_t *mu = c->out + (size_t)comp * BLOCK, *sigma = mu + (size_t)h->feature_dim * BLOCK;

        ted4_prior_slice(&c->prior, m, c->ctx, n, c->added);
        for (size_t i = 0; i < part; i++) {
            if (i % BLOCK >= n)
                continue;
            mu[i] += c->added[i];
            sigma[i] += c->added[part + i];
        }
    }
}

static double milliseconds(void)
{
    struct timespec t;

    clock_gettime(CLOCK_MONOTONIC, &t);
    return 1e3 * (double)t.tv_sec + 1e-6 * (double)t.tv_nsec;
}

/* Evaluates and times all three models for n <= 64 anchors. */
static void evaluate(check *c, size_t first, size_t n)
{
    const double t0 = milliseconds();

    integer_model(c, first, n);
    const double t1 = milliseconds();

    float_model(c->s, c->hidden32, first, n, c->x32, c->y32);
    const double t2 = milliseconds();

    double_model(c->s, c->hidden, first, n, c->x, c->y);
    c->ms[0] += t1 - t0;
    c->ms[1] += t2 - t1;
    c->ms[2] += milliseconds() - t2;
}

static void add_block(check *c, size_t first, size_t n)
{
    const ted4_shape *shape = &c->s->shape;

    evaluate(c, first, n);
    for (size_t a = 0; a < n; a++)
        for (int t = 0; t < TED4_TYPES; t++)
            for (unsigned i = 0; i < shape->dim[t]; i++) {
                const size_t at = (size_t)(shape->first_output[t] + i) * BLOCK + a;
                const size_t sigma = at + (size_t)shape->dim[t] * BLOCK;
                const models m = { c->out[at],         ted4_sigma_index(c->out[sigma]),
                                   c->y[at],           c->y[sigma],
                                   (double)c->y32[at], (double)c->y32[sigma] };

                if (coded(c->s, t, i, first + a))
                    add_symbol(c, t, i, first + a, &m);
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

/* Sorts the substreams into the order of spec 9.1, the masks first. */
static void sort_sizes(check *c)
{
    const ted4_header *h = &c->s->head;
    unsigned at = h->temporal_mask || h->offset_mask;

    for (unsigned m = 0; m < h->n_slices; m++)
        c->cost[TED4_FEATURE].coded_bytes += c->substream[at++];
    for (int t = TED4_SCALING; t < TED4_TYPES; t++)
        if (c->s->shape.dim[t] > 0)
            c->cost[t].coded_bytes += c->substream[at++];
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
    if (ted4_prior_init(&c->prior, &c->s->head, shape, a) != TED4_OK ||
        ted4_prior_load(&c->prior, c->s->nete.values, c->s->shift, NULL) != TED4_OK) {
        fprintf(stderr, "rate_check: networks cannot be loaded\n");
        exit(3);
    }
    c->prior.dense = ted4_select_int_dense();
    c->out = need(a, (size_t)shape->n_outputs * BLOCK, sizeof *c->out);
    c->added = need(a, 2 * TED4_MAX_FEATURE * BLOCK, sizeof *c->added);
    c->ctx = need(a, TED4_MAX_FEATURE * BLOCK, sizeof *c->ctx);
    c->y = need(a, (size_t)shape->n_outputs * BLOCK, sizeof *c->y);
    c->y32 = need(a, (size_t)shape->n_outputs * BLOCK, sizeof *c->y32);
    c->x = need(a, (TED4_PRIOR_INPUTS + TED4_MAX_FEATURE) * BLOCK, sizeof *c->x);
    c->x32 = need(a, (TED4_PRIOR_INPUTS + TED4_MAX_FEATURE) * BLOCK, sizeof *c->x32);
    for (int i = 0; i < 2; i++) {
        c->hidden[i] = need(a, TED4_MAX_WIDTH * BLOCK, sizeof *c->hidden[i]);
        c->hidden32[i] = need(a, TED4_MAX_WIDTH * BLOCK, sizeof *c->hidden32[i]);
    }
}

/* Returns by how many percent a exceeds b. */
static double percent(double a, double b)
{
    return b > 0 ? 100 * (a / b - 1) : 0;
}

static void print_cost(const char *name, const cost *c)
{
    const double coded_bits = 8.0 * (double)c->coded_bytes;

    printf("\"%s\":{\"symbols\":%" PRIu64 ",\"escapes\":%" PRIu64
           ",\"escape_bits\":%.1f,\"coded_bits\":%.0f,"
           "\"integer_bits\":%.1f,\"float64_bits\":%.1f,\"float64_floored_bits\":%.1f,\"float32_"
           "floored_bits\":%.1f,"
           "\"integer_over_float64_percent\":%.4f,\"integer_over_floored_percent\":%.4f,\"rans_"
           "over_integer_percent\":%.4f}",
           name, c->symbols, c->escapes, c->escaped, coded_bits, c->integer, c->real, c->floored,
           c->floored32, percent(c->integer, c->real), percent(c->integer, c->floored),
           percent(coded_bits, c->integer));
}

/* Prints one line of JSON. Returns 0, or 1 if the integer frequencies here differ from those of
 * ted4_count. */
static int print_result(const check *c, const char *path, const ted4_bits *counted)
{
    static const char *const name[TED4_TYPES] = { "feature", "scaling", "offset", "phi", "tau" };
    cost total = { 0 };
    int bad = 0;

    printf("{\"file\":\"%s\",\"anchors\":%" PRIu32
           ",\"integer_ms\":%.3f,\"float32_ms\":%.3f,\"float64_ms\":%.3f,",
           path, c->s->head.n_anchors, c->ms[0], c->ms[1], c->ms[2]);
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
        total.floored32 += x->floored32;
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
    static check c = { .shown = -1 };
    const ted4_options o = { .trace = keep_sizes, .trace_user = &c };
    ted4_error e = { TED4_OK, 0 };
    ted4_arena arena;
    ted4_bits counted;
    size_t size = 0;
    uint8_t *data = argc > 1 ? ted4_read_file(argv[1], &size) : NULL;

    if (data == NULL || (argc != 2 && (argc != 4 || strcmp(argv[2], "-s") != 0))) {
        fprintf(stderr, "rate_check: usage: rate_check FILE.ted4 [-s ANCHOR]\n");
        return 3;
    }
    if (ted4_decode(data, size, &o, &c.s, &e) != TED4_OK ||
        ted4_count(c.s, NULL, &counted, &e) != TED4_OK) {
        fprintf(stderr, "rate_check: %s: byte %zu: %s\n", argv[1], e.offset,
                ted4_status_id(e.code));
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
