/* test_weight_grid.c - train/model/weight_grid.c: weights on coarse grids, one grid per unit.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <math.h>
#include <string.h>

#include "test.h"
#include "larger.h"
#include "train/model/weight_grid.h"
#include "train/math/random.h"

enum { N = 64 };

static void draw(float *x, size_t n, uint64_t key, float scale)
{
    for (size_t i = 0; i < n; i++)
        x[i] = scale * (2.0f * ted4_uniform(key, i) - 1.0f);
}

/* The grid of b bits: 2^b steps up to the next power of two. */
static void test_rounds(void **state)
{
    (void)state;
    for (int bits = 1; bits < TED4_WEIGHT_GRID_FULL(TED4_WEIGHT_GRID_HEADS); bits++) {
        float x[N], was[N];
        double most = 0;

        draw(x, N, (uint64_t)bits, ldexpf(1.7f, bits - 12));
        memcpy(was, x, sizeof x);
        ted4_weight_grid_round(x, N, bits);
        for (int i = 0; i < N; i++)
            most = larger(most, fabsf(was[i]));

        const float step = ldexpf(1.0f, (int)ceil(log2(most)) - bits);

        for (int i = 0; i < N; i++) {
            const float steps = x[i] / step;

            assert_true(steps == rintf(steps));
            assert_true(fabsf(steps) <= ldexpf(1.0f, bits));
            assert_true(fabsf(x[i] - was[i]) <= 0.5f * step);
        }
    }
}

/* Values on a grid do not change; full bits change nothing; zero and nearly zero weights do not
 * change. */
static void test_stays(void **state)
{
    float x[N], once[N], tiny[2] = { 0x1p-100f, -0x1p-149f }, none[3] = { 0, 0, 0 };

    (void)state;
    draw(x, N, 7, 3.0f);
    memcpy(once, x, sizeof x);
    ted4_weight_grid_round(x, N, TED4_WEIGHT_GRID_FULL(TED4_WEIGHT_GRID_HEADS));
    assert_memory_equal(x, once, sizeof x);
    for (int bits = 1; bits < 12; bits++)
        for (int k = 0; k < 40; k++) {
            draw(x, N, 7, 0.9f + 0.01f * (float)k); /* the largest is rounded up to a power of two,
                                                       down to one, or neither */
            ted4_weight_grid_round(x, N, bits);
            memcpy(once, x, sizeof x);
            ted4_weight_grid_round(x, N, bits);
            assert_memory_equal(x, once, sizeof x);
        }
    ted4_weight_grid_round(tiny, 2, 4);
    assert_true(tiny[0] == 0x1p-100f);
    assert_true(tiny[1] == -0x1p-149f);
    ted4_weight_grid_round(none, 3, 4);
    ted4_weight_grid_round(none, 0, 4);
    assert_true(none[0] == 0);
    assert_true(none[1] == 0);
    assert_true(none[2] == 0);
}

static ted4_shape shape_of(unsigned in, unsigned hidden, unsigned out)
{
    ted4_shape s = { 0 };

    s.netr[TED4_NET_DEFORM] =
        (ted4_net_shape) { 2, { (uint16_t)in, (uint16_t)hidden, (uint16_t)out }, 0, 0 };
    s.n_netr = (in + 1) * hidden + (hidden + 1) * out;
    s.netr[TED4_NET_OPACITY] = (ted4_net_shape) { 1, { (uint16_t)in, (uint16_t)out }, s.n_netr, 0 };
    s.n_netr += (in + 1) * out;
    s.n_bank = 10;
    return s;
}

/* The relative error of a unit with small weights is no larger than that of one with large weights;
 * networks and the bank have separate numbers of bits. */
static void test_units(void **state)
{
    const ted4_shape s = shape_of(8, 4, 2);
    const int bits[TED4_WEIGHT_GRIDS] = { 24, 5, 3, 20 };
    float netr[N * 2], was[N * 2], bank[10], bank_was[10];

    (void)state;
    assert_true(s.n_netr <= N * 2);
    draw(netr, s.n_netr, 3, 1.0f);
    draw(netr, 8, 4, 0x1p-10f);
    draw(bank, 10, 5, 1.0f);
    memcpy(was, netr, sizeof netr);
    memcpy(bank_was, bank, sizeof bank);
    ted4_weight_grid_scene(&s, bits, netr, bank);
    for (int i = 0; i < 8; i++)
        assert_true(fabsf(netr[i] - was[i]) <= 0x1p-10f * 0x1p-6f);
    for (int i = 0; i < 36; i++)
        assert_true(fabsf(netr[i] - was[i]) <= 0x1p-6f);
    assert_memory_not_equal(netr, was, 36 * sizeof *netr);
    assert_memory_equal(netr + s.netr[TED4_NET_OPACITY].first, was + s.netr[TED4_NET_OPACITY].first,
                        18 * sizeof *netr);
    assert_memory_not_equal(bank, bank_was, sizeof bank);
    ted4_weight_grid_round(bank_was, 10, 3);
    assert_memory_equal(bank, bank_was, sizeof bank);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_rounds),
        cmocka_unit_test(test_stays),
        cmocka_unit_test(test_units),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
