/* test_generate.c - train/splat/decode.c against a reference in double precision, written from spec
 * 11 (generate_ref.h), for every variant of the header.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "test.h"
#include "generate_case.h"
#include "odd_threads.h"

/* Rounding of binary32 through about six layers of sums of a few terms of size 1. */
#define TOLERANCE 1e-5

static test_case scene;

static ted4_splats run(ted4_generator *g, const ted4_parallel *p)
{
    ted4_splats s;

    ted4_generator_pack(g, scene.net);
    assert_int_equal(ted4_generate(g, &scene.in, p, &s), 0);
    assert_int_equal(s.n, CASE_SPLATS);
    return s;
}

static void check_anchor(const ted4_splats *s, int visible, int lane)
{
    double channel[CASE_CHANNELS], position[3], want[CASE_OFFSETS][REF_OUT];
    const int used = scene.lanes[visible] >> lane & 1;

    case_channels(&scene, visible, lane, channel, position);
    if (used)
        ref_generate(&scene.query, channel, channel, position, want);
    for (int k = 0; k < CASE_OFFSETS; k++) {
        const size_t i = (size_t)((visible * CASE_OFFSETS + k) * TED4_LANES + lane);

        for (int c = 0; c < REF_OUT; c++) {
            const double got = case_member(s, c)[i];

            if (!used)
                assert_true(isfinite(got));
            else if (!(fabs(got - want[k][c]) <= TOLERANCE * (1.0 + fabs(want[k][c]))))
                fail_msg("slot %d lane %d offset %d member %d: %g, not %g", visible, lane, k, c,
                         got, want[k][c]);
        }
        if (!used || want[k][10] == 0.0)
            assert_true(s->opacity[i] == 0.0f);
    }
}

static void check_header(const ted4_header *h, uint32_t num, uint32_t den)
{
    ted4_generator *g;
    ted4_splats s;

    case_make(&scene, h, num, den, num + 7 * den + h->motion);
    g = ted4_generator_new(&scene.layout);
    assert_non_null(g);
    s = run(g, NULL);
    for (int i = 0; i < CASE_BLOCKS; i++)
        for (int lane = 0; lane < TED4_LANES; lane++)
            check_anchor(&s, i, lane);
    ted4_generator_free(g);
}

static void test_variants(void **state)
{
    (void)state;
    for (int bits = 0; bits < 192; bits++) {
        ted4_header h = case_header(bits & 3, bits >> 6);

        h.offset_mask = bits >> 2 & 1;
        h.activation = bits >> 3 & 1;
        h.scale_domain = bits >> 4 & 1;
        h.temporal_mask = (bits >> 5 & 1) && h.motion != TED4_MOTION_NONE;
        check_header(&h, 5, 16);
    }
}

static void test_depths(void **state)
{
    (void)state;
    for (int motion = 0; motion < 4; motion++)
        for (int layers = 0; layers < 4; layers++) {
            ted4_header h = case_header(motion, layers % 3);

            h.head_layers = (uint8_t)layers;
            h.head_width = layers ? 9 : 0;
            h.deform_layers = (uint8_t)(motion ? 2 * layers + 1 : 0);
            check_header(&h, 1, 3);
        }
}

static void test_times(void **state)
{
    /* First and last time, at a row and between rows of a bank of 5, a single frame, and the
     * largest den. */
    static const uint32_t time[][2] = { { 0, 8 },       { 8, 8 }, { 2, 8 }, { 3, 8 },
                                        { 0, 1 },       { 1, 1 }, { 7, 8 }, { 16777214, 16777215 },
                                        { 1, 16777215 } };

    (void)state;
    for (int motion = 0; motion < 4; motion++)
        for (size_t i = 0; i < sizeof time / sizeof time[0]; i++) {
            ted4_header h = case_header(motion, TED4_VIEW_COLOUR);

            check_header(&h, time[i][0], time[i][1]);
            h.bank_rows = h.bank_rows ? 1 : 0;
            check_header(&h, time[i][0], time[i][1]);
        }
}

static void test_activation_off(void **state)
{
    ted4_header h = case_header(TED4_MOTION_BANK, TED4_VIEW_NONE);
    ted4_generator *g;
    ted4_splats s;

    (void)state;
    case_make(&scene, &h, 3, 16, 5);
    scene.in.activation = scene.query.activation = 0;
    g = ted4_generator_new(&scene.layout);
    assert_non_null(g);
    s = run(g, NULL);
    for (int i = 0; i < CASE_BLOCKS; i++)
        for (int lane = 0; lane < TED4_LANES; lane++)
            check_anchor(&s, i, lane);
    ted4_generator_free(g);
}

static void check_same(const ted4_splats *s, const float *copy)
{
    for (int c = 0; c < REF_OUT; c++)
        assert_memory_equal(case_member(s, c), copy + c * CASE_SPLATS, CASE_SPLATS * sizeof *copy);
}

static void test_threads(void **state)
{
    static const ted4_parallel runs[] = { { odd_backwards, NULL }, { odd_threads, NULL } };
    static float copy[REF_OUT * CASE_SPLATS];
    ted4_header h = case_header(TED4_MOTION_BANK, TED4_VIEW_FULL);
    ted4_generator *g;
    ted4_splats s;

    (void)state;
    case_make(&scene, &h, 3, 16, 6);
    g = ted4_generator_new(&scene.layout);
    assert_non_null(g);
    s = run(g, NULL);
    for (int c = 0; c < REF_OUT; c++)
        memcpy(copy + c * CASE_SPLATS, case_member(&s, c), CASE_SPLATS * sizeof *copy);
    for (int i = 0; i < 2; i++) {
        s = run(g, &runs[i]);
        check_same(&s, copy);
    }
    ted4_generator_free(g);
}

/* Fewer visible blocks, none, and more than at first, with the same generator. */
static void test_blocks(void **state)
{
    ted4_header h = case_header(TED4_MOTION_CONCAT, TED4_VIEW_COLOUR);
    ted4_generator *g;
    ted4_splats s;

    (void)state;
    case_make(&scene, &h, 3, 16, 8);
    g = ted4_generator_new(&scene.layout);
    assert_non_null(g);
    ted4_generator_pack(g, scene.net);
    for (size_t n = 0; n <= CASE_BLOCKS; n += 3) {
        scene.in.n_visible = n;
        assert_int_equal(ted4_generate(g, &scene.in, NULL, &s), 0);
        assert_int_equal(s.n, n * CASE_OFFSETS * TED4_LANES);
        for (int i = 0; i < (int)n; i++)
            for (int lane = 0; lane < TED4_LANES; lane++)
                check_anchor(&s, i, lane);
    }
    ted4_generator_free(g);
    ted4_generator_free(NULL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_variants), cmocka_unit_test(test_depths),
        cmocka_unit_test(test_times),    cmocka_unit_test(test_activation_off),
        cmocka_unit_test(test_threads),  cmocka_unit_test(test_blocks),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
