/* test_extremes_recon.c - strict reconstruction and the integer networks at the limits of what a
 * file can contain: symbols, steps, exponents, FP16 positions, weights and durations at the ends of
 * their ranges. A query whose result is not finite is refused; all others give the bits that the
 * text defines (recon_ref.h).
 * SPDX-License-Identifier: BSD-2-Clause */
#include <float.h>
#include <stdlib.h>
#include <string.h>

#include "test.h"
#include "kernel/int_kernel.h"
#include "norm/prior.h"
#include "recon_ref.h"
#include "recon_scene.h"
#include "ted4.h"

enum { MAX_RECORDS = 1024 };

static struct ted4_scene scene;
static double wanted[MAX_RECORDS * REF_VALUES];
static int n_refused, n_answered;

/* A small header in which everything that affects reconstruction is in use. */
static ted4_header base_header(int motion)
{
    ted4_header h = { .n_anchors = 40,
                      .tile_size = 64,
                      .n_offsets = 3,
                      .feature_dim = 6,
                      .prior = TED4_PRIOR_FACTORISED,
                      .n_slices = 1,
                      .slice = { 6 },
                      .view = TED4_VIEW_FULL,
                      .head_layers = 1,
                      .head_width = 9,
                      .activation = 1,
                      .frames = 9,
                      .rate_num = 30,
                      .rate_den = 1,
                      .exponent = 2,
                      .motion = (uint8_t)motion };

    if (motion != TED4_MOTION_NONE) {
        h.deform_layers = 2;
        h.deform_width = 9;
        h.temporal_mask = 1;
    }
    if (motion == TED4_MOTION_BANK || motion == TED4_MOTION_CONCAT) {
        h.phi_dim = 3;
        h.bank_rows = 5;
        h.bank_dim = 7;
    }
    return h;
}

static float record_value(const ted4_gaussians *g, size_t i, int c)
{
    return c < 3     ? g->mean[c][i]
           : c < 6   ? g->scale[c - 3][i]
           : c < 10  ? g->rot[c - 6][i]
           : c == 10 ? g->opacity[i]
                     : g->colour[c - 11][i];
}

/* Makes one query: the result has the bits that the text defines, or is a refusal if these are not
 * all finite. */
static void check(const ted4_query *q)
{
    const size_t n = ref_query(&scene, q, 1, wanted);
    ted4_gaussians g;
    ted4_recon *r;
    int finite = 1;

    assert_true(n > 0);
    assert_true(n <= MAX_RECORDS);
    for (size_t i = 0; i < n * REF_VALUES; i++)
        finite &= isfinite(wanted[i]) != 0;
    assert_int_equal(ted4_recon_new(&r, &scene, NULL), TED4_OK);
    assert_int_equal(ted4_recon_query(r, q, NULL, &g), finite ? TED4_OK : TED4_E_REC_NONFINITE);
    assert_int_equal(g.n, finite ? n : 0);
    for (size_t i = 0; i < g.n; i++)
        for (int c = 0; c < REF_VALUES; c++) {
            const float got = record_value(&g, i, c),
                        want = (float)wanted[i * REF_VALUES + (size_t)c];

            if (ted4_float_bits(got) != ted4_float_bits(want))
                fail_msg("record %zu, value %d: %.9g, not %.9g", i, c, (double)got, (double)want);
        }
    n_refused += !finite;
    n_answered += finite;
    ted4_recon_free(r);
}

static void check_times(void)
{
    static const ted4_query queries[] = {
        { 0, 1, { 0.5f, -2, 3 } },
        { 1, 1, { 0.5f, -2, 3 } },
        { 16777214, 16777215, { -1.5f, 0.25f, 0.125f } },
        { 1, 16777215, { 65504, 0, -65504 } },
    };

    for (size_t i = 0; i < sizeof queries / sizeof *queries; i++)
        check(&queries[i]);
}

static void begin(const ted4_header *h)
{
    n_refused = n_answered = 0;
    scene_make(&scene, h, 41u + h->motion);
}

/* Symbols of all types at the ends of their range and around 0, with the finest and the coarsest
 * step, in both domains of scalings. */
static void test_symbols(void **state)
{
    static const int16_t symbol[] = { 0, 1, -1, 32767, -32767 };
    static const uint8_t step[] = { 0, 128, 255 };

    (void)state;
    for (int domain = 0; domain < 2; domain++)
        for (size_t i = 0; i < sizeof symbol / sizeof *symbol; i++)
            for (size_t k = 0; k < sizeof step; k++) {
                ted4_header h = base_header((int)(i + k) % 4);

                h.scale_domain = (uint8_t)domain;
                begin(&h);
                for (int t = 0; t < TED4_TYPES; t++)
                    for (size_t j = 0; j < scene.shape.dim[t] * (size_t)h.n_anchors; j++) {
                        scene.symbol[t][j] = (int16_t)(j % 7 == 3 ? -symbol[i] : symbol[i]);
                        scene.step_index[t][j % h.n_anchors] = step[k];
                    }
                check_times();
                scene_finish(&scene);
            }
}

/* Extreme values of one type at a time, ordinary ones of the others: durations at their minimum and
 * far above, sizes from 2^-126 to 2^126. */
static void test_types(void **state)
{
    (void)state;
    for (int t = 0; t < TED4_TYPES; t++)
        for (int high = 0; high < 2; high++) {
            ted4_header h = base_header(TED4_MOTION_BANK);

            h.scale_domain = TED4_SCALE_LOG2;
            begin(&h);
            for (size_t j = 0; j < scene.shape.dim[t] * (size_t)h.n_anchors; j++) {
                scene.symbol[t][j] = high ? 32767 : -32767;
                scene.step_index[t][j % h.n_anchors] = 255;
            }
            check_times();
            scene_finish(&scene);
        }
}

/* Durations at their minimum, and times on, just before and just after the edges of an
 * activation. */
static void test_edges(void **state)
{
    const ted4_header h = base_header(TED4_MOTION_CONCAT);

    (void)state;
    begin(&h);
    scene.head.step[TED4_TAU] = 0x1p-7f;
    for (size_t i = 0; i < h.n_anchors; i++) {
        scene.step_index[TED4_TAU][i] = 128;
        scene.symbol[TED4_TAU][i] = 32;                   /* 1/4 */
        scene.symbol[TED4_TAU][2 * h.n_anchors + i] = 96; /* 3/4 */
        scene.symbol[TED4_TAU][h.n_anchors + i] = scene.symbol[TED4_TAU][3 * h.n_anchors + i] =
            (int16_t)(-1536 + 4 * ((int)i % 3 - 1)); /* 2^-12 */
    }
    for (uint32_t at = 0; at <= 4; at++)
        for (int off = -3; off <= 3; off++) {
            const int64_t num = (int64_t)at * (1 << 21) + off;
            const ted4_query q = { (uint32_t)num, 1 << 23, { 1, 2, 3 } };

            if (num >= 0 && num <= 1 << 23)
                check(&q);
        }
    assert_int_equal(n_refused, 0);
    scene_finish(&scene);
}

/* Positions from the smallest FP16 to 1, exponents from -30 to 30, origins from zero to very large
 * ones, and the same for cameras. */
static void test_places(void **state)
{
    static const uint16_t half[] = { 0x0000, 0x8000, 0x0001, 0x8001, 0x03ff,
                                     0x0400, 0x8400, 0x3bff, 0x3c00, 0xbc00 };
    static const float far[] = { 0, 0x1p-126f, 1, 65504, 1e20f, 1e38f, FLT_MAX };

    (void)state;
    for (int exponent = -30; exponent <= 30; exponent += 15)
        for (size_t i = 0; i < sizeof far / sizeof *far; i++) {
            ted4_header h = base_header((int)i % 4);

            h.exponent = (int8_t)exponent;
            for (int c = 0; c < 3; c++)
                h.origin[c] = c == 1 ? -far[i] : far[i];
            begin(&h);
            for (size_t k = 0; k < 3 * (size_t)h.n_anchors; k++)
                scene.position[k] = half[k % (sizeof half / sizeof *half)];
            check_times();
            for (size_t k = 0; k < sizeof far / sizeof *far; k++)
                check(&(ted4_query) { 3, 7, { far[k], -far[k], 0 } });
            scene_finish(&scene);
        }
}

/* Weights, biases and the bank at the limits of FP16 and of binary32: heads saturate, and sums that
 * overflow are refused. */
static void test_weights(void **state)
{
    static const float size[] = { 0, 0x1p-126f, 0x1p-24f, 0x1p-14f, 65504, 1e10f, 1e20f, FLT_MAX };

    (void)state;
    for (size_t i = 0; i < sizeof size / sizeof *size; i++)
        for (int motion = 0; motion < 4; motion++) {
            const ted4_header h = base_header(motion);

            begin(&h);
            for (size_t k = 0; k < scene.netr.n; k++)
                scene.netr.values[k] = scene.netr.values[k] < 0 ? -size[i] : size[i];
            for (size_t k = 0; k < scene.bank.n; k++)
                scene.bank.values[k] = scene.bank.values[k] < 0 ? -size[i] : size[i];
            check_times();
            if (size[i] < 1e5f)
                assert_int_equal(n_refused, 0);
            if (size[i] > 1e30f)
                assert_int_equal(n_answered, 0);
            scene_finish(&scene);
        }
}

/* ---- integer networks ---- */

enum { IN = 64, OUT = 25, BLOCK = TED4_PRIOR_BLOCK };

/* A layer whose sums reach, but do not exceed, the range of 32 bits: sum |W| 32767 + |B| + 2^(r-1)
 * is 2^31 - 1, for every shift r from 0 on. */
static void test_sums(void **state)
{
    static _Alignas(64) int16_t w[OUT * IN], x[IN * BLOCK], h[OUT * BLOCK], fast_h[OUT * BLOCK];
    static _Alignas(64) int32_t b[OUT], y[OUT * BLOCK], fast_y[OUT * BLOCK];
    static uint8_t r[OUT];
    const ted4_int_layer l = { IN, IN, OUT, w, b, r };

    (void)state;
    for (int sign = -1; sign <= 1; sign += 2) {
        for (int o = 0; o < OUT; o++) {
            const int64_t half = o > 0 ? (int64_t)1 << (o - 1) : 0;
            int64_t left = INT32_MAX - half;

            for (int i = 0; i < IN; i++) {
                const int64_t most = left / 32767 < 32767 ? left / 32767 : 32767;

                w[o * IN + i] = (int16_t)(i % 2 ? -most : most);
                left -= most * 32767;
            }
            b[o] = (int32_t)(sign * left);
            r[o] = (uint8_t)o;
        }
        for (int i = 0; i < IN; i++)
            for (int a = 0; a < BLOCK; a++)
                x[i * BLOCK + a] =
                    (int16_t)(a % 4 == 0 ? 32767
                              : a % 4 == 1
                                  ? -32767
                                  : (i % 2 ? -1 : 1) * (a % 4 == 2 ? sign : -sign) * 32767);
        ted4_int_dense_plain.hidden(&l, x, BLOCK, h);
        ted4_int_dense_plain.last(&l, x, BLOCK, y);
        ted4_select_int_dense()->hidden(&l, x, BLOCK, fast_h);
        ted4_select_int_dense()->last(&l, x, BLOCK, fast_y);
        assert_memory_equal(h, fast_h, sizeof h);
        assert_memory_equal(y, fast_y, sizeof y);
        for (int o = 0; o < OUT; o++)
            for (int a = 0; a < BLOCK; a++) {
                int64_t sum = b[o];

                for (int i = 0; i < IN; i++)
                    sum += (int64_t)w[o * IN + i] * x[i * BLOCK + a];
                sum += o > 0 ? (int64_t)1 << (o - 1) : 0;
                assert_true(sum >= INT32_MIN);
                assert_true(sum <= INT32_MAX);
                if (a % 4 == 2)
                    assert_true(sum > INT32_MAX - 32768 || sum < INT32_MIN + ((int64_t)1 << 25));
                const int64_t shifted =
                    (sum - ((sum % ((int64_t)1 << o) + ((int64_t)1 << o)) % ((int64_t)1 << o))) /
                    ((int64_t)1 << o);
                const int64_t want_h = shifted < 0 ? 0 : shifted > 32767 ? 32767 : shifted;
                const int64_t want_y = shifted < -TED4_OUTPUT_MAX  ? -TED4_OUTPUT_MAX
                                       : shifted > TED4_OUTPUT_MAX ? TED4_OUTPUT_MAX
                                                                   : shifted;

                assert_int_equal(h[o * BLOCK + a], want_h);
                assert_int_equal(y[o * BLOCK + a], want_y);
            }
    }
}

/* The meaning of outputs at their extreme values: an output of the hyperprior plus the
 * contributions of all slices. */
static void test_indices(void **state)
{
    static const int32_t output[] = { 0, TED4_OUTPUT_MAX, -TED4_OUTPUT_MAX, 2 * TED4_OUTPUT_MAX,
                                      -2 * TED4_OUTPUT_MAX };

    (void)state;
    for (size_t i = 0; i < sizeof output / sizeof *output; i++) {
        assert_int_equal(ted4_step_index(output[i]), output[i] == 0  ? 128
                                                     : output[i] > 0 ? 255
                                                                     : 0);
        assert_int_equal(ted4_sigma_index(output[i]), output[i] == 0  ? 64
                                                      : output[i] > 0 ? TED4_N_SIGMA - 1
                                                                      : 0);
    }
    for (unsigned bits = 0; bits <= 12; bits++)
        for (int index = 0; index < 256; index++)
            for (int k = -32767; k <= 32767; k += 32767) {
                const int got = ted4_context((int16_t)k, (uint8_t)index, bits);
                const double want =
                    fmin(fmax(k * exp2((index - 128) / 32.0 + bits), -32767), 32767);

                assert_true(fabs(got - want) <= 2.5e-3 * fabs(want) + 0.5);
            }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_symbols), cmocka_unit_test(test_types),
        cmocka_unit_test(test_edges),   cmocka_unit_test(test_places),
        cmocka_unit_test(test_weights), cmocka_unit_test(test_sums),
        cmocka_unit_test(test_indices),
    };

    return cmocka_run_group_tests_name("reconstruction at extreme values", tests, NULL, NULL);
}
