/* test_settle_positions.c - train/step/settle_positions.c: positions lie on the grid of profile
 * Compact (spec 8.2), one anchor in a cell, and Gaussians stay where they are; in profile Main they
 * are binary16 values, and anchors that coincide are dropped.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <math.h>
#include <stdlib.h>

#include "cloud_case.h"
#include "larger.h"
#include "norm/half.h"
#include "norm/scene.h"
#include "test.h"
#include "train/step/export_scene.h"
#include "train/step/settle_positions.h"
#include "write/coded.h"

enum { FRAMES = 5 };

static cloud_case cloud;

static float *value(const ted4_trainer *t, ted4_row row, size_t i, int channel)
{
    return ted4_anchor_value(&t->anchors, row, i, channel);
}

static void place(const ted4_trainer *t, size_t i, float x, float y, float z)
{
    *value(t, TED4_ROW_POSITION, i, 0) = x;
    *value(t, TED4_ROW_POSITION, i, 1) = y;
    *value(t, TED4_ROW_POSITION, i, 2) = z;
}

/* Begins a trainer with n anchors at positions of their own, and offsets and sizes in a pattern. */
static void begin(ted4_trainer *t, int profile, int grid, size_t n)
{
    uint32_t all[CLOUD_POINTS];

    cloud_make(&cloud, FRAMES);
    cloud.options.profile = profile;
    cloud.options.grid = grid;
    cloud_begin(&cloud, t);
    assert_true(t->anchors.n >= n);
    for (size_t i = 0; i < n; i++)
        all[i] = (uint32_t)i;
    assert_int_equal(ted4_anchors_select(&t->anchors, all, n), 0);
    for (size_t i = 0; i < n; i++) {
        place(t, i, -0.9f + 1.7f * (float)i / (float)n, 0.3f - 0.013f * (float)i,
              0.01f * (float)(i * i % 37));
        for (int j = 0; j < 3; j++)
            *value(t, TED4_ROW_VALUE, i, t->layout.first[TED4_SCALING] + j) =
                -5.0f + 0.5f * (float)j + 0.01f * (float)i;
        for (int c = 0; c < 3 * t->layout.head.n_offsets; c++)
            *value(t, TED4_ROW_VALUE, i, t->layout.first[TED4_OFFSET] + c) = 0.1f * (float)c;
    }
}

/* Where Gaussian k of anchor i is on axis j. */
static double centre(const ted4_trainer *t, size_t i, int k, int j)
{
    return (double)*value(t, TED4_ROW_POSITION, i, j) +
           (double)*value(t, TED4_ROW_VALUE, i, t->layout.first[TED4_OFFSET] + 3 * k + j) *
               exp2((double)*value(t, TED4_ROW_VALUE, i, t->layout.first[TED4_SCALING] + j));
}

/* Asserts that all positions lie on the grid, each in a cell of its own. */
static void check_cells(const ted4_trainer *t, unsigned bits)
{
    uint64_t *key = malloc((t->anchors.n + 1) * sizeof *key);

    assert_non_null(key);
    for (size_t i = 0; i < t->anchors.n; i++) {
        for (int j = 0; j < 3; j++) {
            const float x = *value(t, TED4_ROW_POSITION, i, j);

            assert_true(x >= -1 && x < 1);
            assert_true(ted4_grid_place(ted4_float_to_half(x), bits) != UINT32_MAX);
            assert_true(!(ted4_half_to_float(ted4_float_to_half(x)) != x));
        }
        key[i] = ted4_position_key(t, i);
        for (size_t k = 0; k < i; k++)
            assert_true(key[k] != key[i]);
    }
    free(key);
}

static void test_gaussians_stay(void **state)
{
    (void)state;
    for (int bits = 6; bits <= 12; bits++) {
        enum { N = 40 };
        ted4_trainer t;
        double before[N][3], after[N][3];

        begin(&t, 1, bits, N);
        for (size_t i = 0; i < N; i++)
            for (int j = 0; j < 3; j++)
                before[i][j] = centre(&t, i, 2, j);
        assert_int_equal(ted4_settle_positions(&t), 0);
        assert_int_equal(t.anchors.n, N);
        check_cells(&t, (unsigned)bits);
        for (size_t i = 0; i < N; i++) {
            double least = 1;

            for (int j = 0; j < 3; j++)
                after[i][j] = centre(&t, i, 2, j);
            for (size_t k = 0; k < N; k++) /* the order has changed */
                least = fmin(least, fabs(before[k][0] - after[i][0]) +
                                        fabs(before[k][1] - after[i][1]) +
                                        fabs(before[k][2] - after[i][2]));
            if (!(least < 2e-3)) /* rounding to binary16 comes first */
                fail_msg("%d bits: anchor %zu is %g away", bits, i, least);
        }
        ted4_trainer_finish(&t);
    }
}

/* 30 anchors in one cell: they take it, the 26 cells around it, and three are dropped. */
static void test_crowded_cell(void **state)
{
    const float cell = 0x1p-11f;
    ted4_trainer t;
    int nearest = 0;

    (void)state;
    begin(&t, 1, 12, 30);
    for (size_t i = 0; i < 30; i++)
        place(&t, i, 0.25f + 0.001f * cell * (float)i, 0.125f, -0.125f);
    assert_int_equal(ted4_settle_positions(&t), 0);
    assert_int_equal(t.anchors.n, 27);
    check_cells(&t, 12);
    for (size_t i = 0; i < 27; i++) {
        double far = 0;

        for (int j = 0; j < 3; j++)
            far = larger(far, fabsf(*value(&t, TED4_ROW_POSITION, i, j) - (j == 0   ? 0.25f
                                                                           : j == 1 ? 0.125f
                                                                                    : -0.125f)));
        nearest += !(far > 0);
        assert_true(far <= cell);
    }
    assert_int_equal(nearest, 1);
    ted4_trainer_finish(&t);
}

/* The second of two anchors in a cell goes to the side where it lies. The grid ends one cell before
 * 1, which is where what lies there goes. */
static void test_second_in_a_cell(void **state)
{
    const float cell = 0x1p-5f;
    ted4_trainer t;
    int aside = 0, back = 0;

    (void)state;
    begin(&t, 1, 6, 4);
    place(&t, 0, 0.25f, 0.0f, 0.0f);
    place(&t, 1, 0.25f, 0.3f * cell, 0.0f);
    place(&t, 2, 1.0f, -0.5f, -0.5f);
    place(&t, 3, 1.0f - 0.1f * cell, -0.5f, -0.5f);
    assert_int_equal(ted4_settle_positions(&t), 0);
    assert_int_equal(t.anchors.n, 4);
    check_cells(&t, 6);
    for (size_t i = 0; i < 4; i++) {
        aside += fabsf(*value(&t, TED4_ROW_POSITION, i, 1) - cell) < 1e-6f &&
                 fabsf(*value(&t, TED4_ROW_POSITION, i, 0) - 0.25f) < 1e-6f;
        back += fabsf(*value(&t, TED4_ROW_POSITION, i, 0) - (1.0f - cell)) < 1e-6f;
    }
    assert_int_equal(aside, 1);
    assert_int_equal(back, 2);
    ted4_trainer_finish(&t);
}

static void test_main(void **state)
{
    ted4_trainer t;

    (void)state;
    begin(&t, 0, 12, 5);
    for (size_t i = 0; i < 2; i++) /* two values that round to the same binary16 */
        place(&t, i, 0.3f + 1e-6f * (float)i, 0.1f, 0.1f);
    assert_int_equal(ted4_settle_positions(&t), 0);
    assert_int_equal(t.anchors.n, 4);
    for (size_t i = 0; i < 4; i++) {
        const float x = *value(&t, TED4_ROW_POSITION, i, 0);

        assert_true(!(ted4_half_to_float(ted4_float_to_half(x)) != x));
        if (fabsf(x - 0.3f) < 1e-3f)
            for (int c = 0; c < 3 * t.layout.head.n_offsets; c++) /* offsets do not change */
                assert_true(!(*value(&t, TED4_ROW_VALUE, i, t.layout.first[TED4_OFFSET] + c) !=
                              0.1f * (float)c));
    }
    assert_int_equal(ted4_position_bits(&t), 16);
    ted4_trainer_finish(&t);
}

/* The grid with the fewest bits, where all offsets have magnitude 1 and all sizes are 2^size: an
 * anchor's position has 3 bits a level, and each of its offsets grows by the variance of a uniform
 * distribution over a cell. */
static int cheapest(int size, int offsets)
{
    double least = INFINITY;
    int best = 0;

    for (int g = 6; g <= 12; g++) {
        const double moved = exp2(1 - g - size), variance = moved * moved / 12;
        const double bits = 3 * g + 3 * offsets * 0.5 * log2(1 + variance / (acos(-1.0) / 2));

        if (bits < least) {
            least = bits;
            best = g;
        }
    }
    return best;
}

static void test_cheapest_grid(void **state)
{
    int seen[13] = { 0 };

    (void)state;
    for (int size = -14; size <= 0; size++) {
        ted4_trainer t;

        begin(&t, 1, 0, 30);
        for (size_t i = 0; i < 30; i++) {
            for (int j = 0; j < 3; j++)
                *value(&t, TED4_ROW_VALUE, i, t.layout.first[TED4_SCALING] + j) = (float)size;
            for (int c = 0; c < 3 * t.layout.head.n_offsets; c++)
                *value(&t, TED4_ROW_VALUE, i, t.layout.first[TED4_OFFSET] + c) =
                    (i + (size_t)c) % 2 ? 1.0f : -1.0f;
        }
        assert_int_equal(ted4_position_bits(&t), 16); /* before stage 2 */
        assert_int_equal(ted4_settle_positions(&t), 0);
        assert_int_equal(ted4_position_bits(&t), cheapest(size, t.layout.head.n_offsets));
        check_cells(&t, ted4_position_bits(&t));
        seen[ted4_position_bits(&t)]++;
        ted4_trainer_finish(&t);
    }
    for (int g = 6; g <= 12; g++)
        assert_true(seen[g] > 0);
}

/* A grid that no file can have is refused. */
static void test_impossible_grid(void **state)
{
    ted4_trainer t;

    (void)state;
    cloud_make(&cloud, FRAMES);
    cloud.options.grid = 5;
    assert_int_equal(ted4_trainer_init(&t, &cloud.options, &cloud.data, NULL), -1);
    assert_non_null(strstr(t.message.text, "grid"));
    ted4_trainer_finish(&t);
}

/* The writer finds the grid, whose order the scene has. */
static void test_export(void **state)
{
    (void)state;
    for (int bits = 9; bits <= 12; bits += 3) {
        ted4_trainer t;
        ted4_scene *s;

        begin(&t, 1, bits, 40);
        if (ted4_export_scene(&t, &s) != 0)
            fail_msg("%s", t.message.text);
        assert_int_equal(s->profile, TED4_PROFILE_COMPACT);
        assert_int_equal(ted4_coarsest_grid(s->position, s->head.n_anchors), bits);
        ted4_scene_free(s);
        ted4_trainer_finish(&t);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_gaussians_stay),   cmocka_unit_test(test_crowded_cell),
        cmocka_unit_test(test_second_in_a_cell), cmocka_unit_test(test_main),
        cmocka_unit_test(test_export),           cmocka_unit_test(test_cheapest_grid),
        cmocka_unit_test(test_impossible_grid),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
