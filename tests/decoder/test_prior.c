/* test_prior.c - norm/prior.c and write/snap.c: conversion of binary32 to integers, evaluation, and
 * the rules of spec 7.3 and 10.1.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <math.h>
#include <stdlib.h>

#include "test.h"
#include "random_scene.h"

/* A long double holds a binary32 times a power of two exactly, and rintl() rounds to nearest, ties
 * to even. */
static void integerise(void **state)
{
    random_source r = random_seed(1);

    (void)state;
    for (int n = 0; n < 2000000; n++) {
        const int e = (int)random_in(&r, 0, 32);
        uint32_t bits = random_u32(&r);
        long double v;

        if (n % 4 != 0) /* near the rounding point, half of them ties */
            bits = (bits & 0x80000000) | (uint32_t)(127 + (int)random_in(&r, 0, 20) - e) << 23 |
                   (bits & 0x7fffff & (n % 2 ? 0xffffffff : 0x7c0000));
        if (!ted4_float_legal(bits))
            continue;
        v = rintl(ldexpl((long double)ted4_bits_float(bits), e));
        if (fabsl(v) < 4e18L)
            assert_int_equal(ted4_rne_scaled(bits, e), (int64_t)v);
        else
            assert_true(llabs(ted4_rne_scaled(bits, e)) >= (int64_t)1 << 61);
    }
    assert_int_equal(ted4_rne_scaled(0, 32), 0);
    assert_int_equal(ted4_rne_scaled(0x3f000000, 0), 0); /* 0.5 */
    assert_int_equal(ted4_rne_scaled(0x3fc00000, 0), 2); /* 1.5 */
    assert_int_equal(ted4_rne_scaled(0x40200000, 0), 2); /* 2.5 */
    assert_int_equal(ted4_rne_scaled(0xc0200000, 0), -2);
}

static void fixed_point(void **state)
{
    random_source r = random_seed(2);

    (void)state;
    for (int n = 0; n < 1000000; n++) {
        const int32_t x = (int32_t)random_u32(&r) / 2;
        const unsigned s = random_in(&r, 0, 30);
        const double v = ldexp(x, -(int)s);

        if (ted4_floor_shift(x, s) != (int32_t)floor(v) ||
            ted4_round_shift(x, s) != (int32_t)floor(s ? v + 0.5 : v))
            fail();
    }
    for (uint32_t x = 1; x < 1 << 20; x += 7)
        if (ted4_log2_floor(x) != (unsigned)floor(log2(x)))
            fail();
}

/* spec 7.3 in 64 bits, from the binary32 values. x: [in]; y: [out]. */
static void oracle_layer(const float *w, const uint8_t *shift, unsigned in, unsigned out, int f,
                         int g, const int64_t *x, int64_t *y)
{
    for (unsigned o = 0; o < out; o++) {
        const int64_t r = shift[o] + f - g;
        int64_t acc = (int64_t)rint(ldexp(w[(size_t)in * out + o], shift[o] + f));

        for (unsigned i = 0; i < in; i++) {
            acc += (int64_t)rint(ldexp(w[(size_t)o * in + i], shift[o])) * x[i];
            assert_true(llabs(acc) <= INT32_MAX);
        }
        acc = (int64_t)floor(ldexp((double)acc, -(int)r) + (r > 0 ? 0.5 : 0));
        y[o] = g == 10                  ? (acc < 0       ? 0
                                           : acc > 32767 ? 32767
                                                         : acc)
               : acc < -((1 << 26) - 1) ? -((1 << 26) - 1)
               : acc > (1 << 26) - 1    ? (1 << 26) - 1
                                        : acc;
    }
}

static void oracle_net(const ted4_net_shape *n, const float *nete, const uint8_t *shift, int f,
                       const int64_t *input, int64_t *output)
{
    int64_t hidden[2][TED4_MAX_WIDTH];
    size_t at = n->first, unit = n->first_unit;

    for (unsigned i = 0; i < n->n_layers; i++) {
        const int last = i + 1u == n->n_layers;

        oracle_layer(nete + at, shift + unit, n->dim[i], n->dim[i + 1], i > 0 ? 10 : f,
                     last ? 8 : 10, i > 0 ? hidden[i % 2] : input,
                     last ? output : hidden[(i + 1) % 2]);
        at += (n->dim[i] + (size_t)1) * n->dim[i + 1];
        unit += n->dim[i + 1];
    }
}

/* spec 10.1 in floating point: the result is within one unit of the last place of Q12 of the true
 * sine. */
static void check_inputs(const ted4_header *h, const uint16_t *p, int64_t *x)
{
    unsigned at = 3;

    for (int j = 0; j < 3; j++)
        x[j] = (int64_t)floor(4096 * (double)ted4_half_to_float(p[j]));
    for (unsigned l = 0; l < h->pe_octaves; l++)
        for (int j = 0; j < 3; j++)
            for (int c = 0; c < 2; c++, at++) {
                const uint32_t X = (uint32_t)(int32_t)(16777216 * (double)ted4_half_to_float(p[j]));
                const uint32_t u = (X << (7 + l)) + (c ? 0x40000000u : 0);
                const unsigned i = u >> 22, b = u >> 10 & 4095;
                const double a = ted4_sin[i], d = ted4_sin[i + 1] - a;

                x[at] = (int64_t)(a + floor(d * b / 4096 + 0.5));
                assert_true(fabs((double)x[at] - 4096 * sin(u / 4294967296.0 * 6.283185307179586)) <
                            1.6);
            }
}

static void evaluation(void **state)
{
    (void)state;
    for (uint64_t seed = 0; seed < 60; seed++) {
        ted4_scene *s = random_scene(seed);
        const ted4_shape *sh = &s->shape;
        ted4_arena arena;
        ted4_prior p;
        int32_t *out = malloc(sizeof *out * 64 * (sh->n_outputs + 512));
        int64_t x[TED4_PRIOR_INPUTS], y[600];
        const size_t n = s->head.n_anchors < 64 ? s->head.n_anchors : 64;

        ted4_arena_init(&arena, NULL);
        assert_int_equal(ted4_prior_init(&p, &s->head, sh, &arena), TED4_OK);
        assert_int_equal(ted4_prior_load(&p, s->nete.values, s->shift, NULL), TED4_OK);
        ted4_prior_hyper(&p, s->position, n, out);
        for (size_t a = 0; a < n; a++) {
            check_inputs(&s->head, s->position + 3 * a, x);
            oracle_net(&sh->hyper, s->nete.values, s->shift, 12, x, y);
            for (unsigned o = 0; o < sh->n_outputs; o++)
                assert_int_equal(out[64 * o + a], y[o]);
        }
        free(out);
        ted4_arena_finish(&arena);
        ted4_scene_free(s);
    }
}

/* Slice networks with contexts at the ends of their range: the accumulator bound holds, also in the
 * order of the oracle. */
static void slices(void **state)
{
    random_source r = random_seed(5);

    (void)state;
    for (uint64_t seed = 0; seed < 60; seed++) {
        ted4_scene *s = random_scene(seed);
        ted4_arena arena;
        ted4_prior p;
        _Alignas(64) static int16_t ctx[128 * 64];
        static int32_t out[256 * 64];
        int64_t x[128], y[256];

        ted4_arena_init(&arena, NULL);
        (void)ted4_prior_init(&p, &s->head, &s->shape, &arena);
        (void)ted4_prior_load(&p, s->nete.values, s->shift, NULL);
        for (size_t i = 0; i < 128 * 64; i++)
            ctx[i] = (int16_t)(i % 3                 ? (int)random_in(&r, 0, 2000)
                               : random_in(&r, 0, 1) ? 32767
                                                     : -32767);
        for (unsigned m = 1; m < s->head.n_slices; m++) {
            ted4_prior_slice(&p, m, ctx, 64, out);
            for (size_t a = 0; a < 64; a++) {
                for (unsigned i = 0; i < s->shape.slice[m].dim[0]; i++)
                    x[i] = ctx[64 * i + a];
                oracle_net(&s->shape.slice[m], s->nete.values, s->shift, s->head.context_bits, x,
                           y);
                for (unsigned o = 0; o < s->shape.slice[m].dim[2]; o++)
                    assert_int_equal(out[64 * o + a], y[o]);
            }
        }
        ted4_arena_finish(&arena);
        ted4_scene_free(s);
    }
}

/* For weights of any size, the result of ted4_snap is legal, on the grid, and near its input unless
 * that was too large. */
static void snapping(void **state)
{
    random_source r = random_seed(6);

    (void)state;
    for (int n = 0; n < 200; n++) {
        const ted4_header h = random_header(&r);
        ted4_shape s;
        ted4_arena arena;
        ted4_prior p;
        ted4_error e = { TED4_OK, 0 };
        float *v, *was;
        uint8_t *shift;
        const int wild = n % 4 == 3;

        ted4_shape_make(&s, &h);
        v = malloc(s.n_nete * sizeof *v);
        was = malloc(s.n_nete * sizeof *was);
        shift = malloc(s.n_units);
        for (size_t i = 0; i < s.n_nete; i++) {
            v[i] = (float)(random_normal(&r) * 0.3);
            if (wild && random_in(&r, 0, 9) == 0)
                v[i] = ted4_bits_float(random_u32(&r));
        }
        memcpy(was, v, s.n_nete * sizeof *v);
        ted4_snap(&h, &s, v, shift);
        ted4_arena_init(&arena, NULL);
        (void)ted4_prior_init(&p, &h, &s, &arena);
        assert_int_equal(ted4_prior_load(&p, v, shift, &e), TED4_OK);
        for (size_t i = 0; i < s.n_nete; i++) {
            assert_true(ted4_float_legal(ted4_float_bits(v[i])));
            if (!wild) /* 30 inputs leave at least 11 bits for a weight below 2 */
                assert_true(fabsf(v[i] - was[i]) < 0.0005f);
        }
        memcpy(was, v, s.n_nete * sizeof *v);
        ted4_snap(&h, &s, v, shift);
        assert_memory_equal(was, v, s.n_nete * sizeof *v);
        ted4_snap_coarse(&h, &s, 6, v, shift);
        assert_int_equal(ted4_prior_load(&p, v, shift, &e), TED4_OK);
        for (size_t i = 0; i < s.n_units; i++)
            assert_true(shift[i] <=
                        10); /* 6, or as many as a slice network with few context bits needs */
        ted4_arena_finish(&arena);
        free(v);
        free(was);
        free(shift);
    }
}

static const char *load_with(ted4_prior *p, float *v, uint8_t *shift, size_t *at)
{
    ted4_error e = { TED4_OK, 0 };

    (void)ted4_prior_load(p, v, shift, &e);
    *at = e.offset;
    return ted4_status_id(e.code);
}

/* Breaks each rule alone, and tests values just inside it. The network has no octaves, so 3 inputs,
 * and no hidden layer. */
static void rules(void **state)
{
    ted4_header h = random_paper_header(1);
    ted4_shape s;
    ted4_arena arena;
    ted4_prior p;
    float *v;
    uint8_t *shift;
    size_t at, bias;

    (void)state;
    h.pe_octaves = h.hyper_layers = 0;
    h.hyper_width = h.ar_width = 0;
    h.n_slices = 1;
    h.slice[0] = h.feature_dim;
    ted4_shape_make(&s, &h);
    v = calloc(s.n_nete, sizeof *v);
    shift = calloc(s.n_units, 1);
    bias = 3 * (size_t)s.n_outputs;
    ted4_arena_init(&arena, NULL);
    (void)ted4_prior_init(&p, &h, &s, &arena);
    assert_string_equal(load_with(&p, v, shift, &at), "ok");
    shift[7] = 21;
    assert_string_equal(load_with(&p, v, shift, &at), "net.shift");
    assert_int_equal(at, 7);
    shift[7] = 20;
    assert_string_equal(load_with(&p, v, shift, &at), "ok");
    v[22] = 32767.0f / 1048576; /* row 7 */
    assert_string_equal(load_with(&p, v, shift, &at), "ok");
    v[22] = -32768.0f / 1048576;
    assert_string_equal(load_with(&p, v, shift, &at), "net.weight-range");
    assert_int_equal(at, 22);
    v[22] = -0.0f;
    assert_string_equal(load_with(&p, v, shift, &at), "net.value");
    v[22] = 1e-40f;
    assert_string_equal(load_with(&p, v, shift, &at), "net.value");
    v[22] = INFINITY;
    assert_string_equal(load_with(&p, v, shift, &at), "net.value");
    v[22] = 0;
    /* shift 0: r = 4, half = 8; B = b 2^12; the bound is 2^31 - 1 */
    v[bias] = (float)((2147483648.0 - 128) / 4096);
    assert_string_equal(load_with(&p, v, shift, &at), "ok");
    v[bias] = (float)(2147483648.0 / 4096);
    assert_string_equal(load_with(&p, v, shift, &at), "net.accumulator");
    assert_int_equal(at, bias);
    v[bias] = 3e38f;
    assert_string_equal(load_with(&p, v, shift, &at), "net.accumulator");
    /* 3 x 32767 x 4096 + |B| + 8 <= 2^31 - 1 leaves |B| <= 1744842743 */
    v[0] = v[1] = v[2] = 32767;
    v[bias] = -(float)(1744842624.0 / 4096);
    assert_string_equal(load_with(&p, v, shift, &at), "ok");
    v[bias] = -(float)(1744842752.0 / 4096);
    assert_string_equal(load_with(&p, v, shift, &at), "net.accumulator");
    ted4_arena_finish(&arena);
    free(v);
    free(shift);
}

static void indices(void **state)
{
    (void)state;
    assert_int_equal(ted4_step_index(0), 128);
    assert_int_equal(ted4_step_index(4), 129);
    assert_int_equal(ted4_step_index(3), 128);
    assert_int_equal(ted4_step_index(-4), 128);
    assert_int_equal(ted4_step_index(-5), 127);
    assert_int_equal(ted4_step_index(100000), 255);
    assert_int_equal(ted4_step_index(-100000), 0);
    assert_int_equal(ted4_sigma_index(16), 65);
    assert_int_equal(ted4_sigma_index(-100000), 0);
    assert_int_equal(ted4_sigma_index(100000), 239);
    assert_int_equal(ted4_context(3, 128, 8), 768);
    assert_int_equal(ted4_context(-3, 128, 0), -3);
    assert_int_equal(ted4_context(32767, 255, 12), 32767);
    assert_int_equal(ted4_context(-32767, 255, 12), -32767);
    assert_int_equal(ted4_context(1, 96, 0), 1); /* 0.5 rounds up */
    assert_int_equal(ted4_context(-1, 96, 0), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(integerise), cmocka_unit_test(fixed_point), cmocka_unit_test(evaluation),
        cmocka_unit_test(slices),     cmocka_unit_test(snapping),    cmocka_unit_test(rules),
        cmocka_unit_test(indices),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
