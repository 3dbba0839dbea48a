/* test_compact.c - the measurements of bench/compact, where the answer is known: symbols drawn from
 * the models themselves, which nothing can improve; symbols that miss their means as their
 * neighbours do; masks that repeat; weights that are zero; positions on the grid already.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "test.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "bench/compact.h"
#include "norm/half.h"
#include "random_scene.h"
#include "write/encode.h"

/* n anchors, whose symbols are drawn from their models. */
static ted4_scene *drawn_scene(uint64_t seed, uint32_t n)
{
    random_source r = random_seed(seed);
    const ted4_header h = random_paper_header(n);

    return random_scene_of(&r, &h, 0);
}

static void models(void **state)
{
    ted4_scene *const s = drawn_scene(1, 1000);
    int32_t *const near = compact_near_levels(s);
    compact_models m;
    double today = 0, fitted = 0;
    ted4_bits counted;
    ted4_error e;

    (void)state;
    assert_int_equal(ted4_count(s, NULL, &counted, &e), TED4_OK);
    compact_models_make(&m, s);
    for (int t = 0; t < TED4_TYPES; t++) {
        compact_fitted f;

        if (s->shape.dim[t] == 0)
            continue;
        compact_fit(&m, t, near, near, &f);
        assert_true(fabs(f.today / counted.type[t] - 1) < 0.02);
        assert_true(f.blind <= f.today && f.near_levels <= f.today);
        today += f.today;
        fitted += f.near_levels;
        assert_true(fabs(compact_mixed(&m, t, NULL) / f.today - 1) < 0.05);
    }
    assert_true(fitted > 0.97 * today);
    compact_models_free(&m);
    free(near);
    ted4_scene_free(s);
}

/* Every anchor misses its mean by the same three deviations, in one and the same step. */
static void neighbours(void **state)
{
    ted4_scene *const s = drawn_scene(2, 400);
    int32_t *const levels = compact_near_levels(s), *const before = compact_near_before(s);
    compact_models m;
    compact_fitted f;

    (void)state;
    compact_models_make(&m, s);
    memset(s->step_index[TED4_SCALING], 128, m.n);
    for (size_t i = 0; i < 6 * m.n; i++) {
        m.sigma[TED4_SCALING][i] = 64 + 32;
        s->symbol[TED4_SCALING][i] = (int16_t)(m.mu[TED4_SCALING][i] / 256 + 12);
    }
    compact_fit(&m, TED4_SCALING, levels, before, &f);
    assert_true(f.near_levels < 0.5 * f.blind);
    assert_true(f.near_before < f.near_levels);
    assert_true(compact_mixed(&m, TED4_SCALING, levels) < 0.7 * f.today);
    compact_models_free(&m);
    free(levels);
    free(before);
    ted4_scene_free(s);
}

/* Whom an anchor may look at. */
static void causal(void **state)
{
    ted4_scene *const s = drawn_scene(3, 333);
    int32_t *l, *b;

    (void)state;
    s->head.tile_size = 64;
    l = compact_near_levels(s);
    b = compact_near_before(s);
    for (int32_t a = 0; a < 333; a++)
        for (int i = 0; i < COMPACT_NEAR; i++) {
            const int32_t x = l[COMPACT_NEAR * a + i], y = b[COMPACT_NEAR * a + i];

            if (x != COMPACT_NONE) {
                assert_int_equal(x / 64, a / 64);
                assert_true(x % 64 % 4 == 0 ? a % 64 % 4 != 0 : x % 64 % 4 == 2 && a % 64 % 2 == 1);
            }
            assert_true(y == COMPACT_NONE || (y / 64 == a / 64 && y < a));
            assert_int_equal(y == COMPACT_NONE, a % 64 <= i);
        }
    free(l);
    free(b);
    ted4_scene_free(s);
}

static void masks(void **state)
{
    ted4_scene *const s = drawn_scene(4, 1000);
    int32_t *const near = compact_near_levels(s);
    double adaptive, mixed;

    (void)state;
    for (size_t a = 0; a < 1000; a++) {
        s->dynamic[a] = 1;
        s->offset_bits[a] = 0x2d;
    }
    compact_masks(s, near, &adaptive, &mixed);
    assert_true(s->head.offset_mask && s->head.temporal_mask);
    assert_true(mixed < 0.2 * adaptive && mixed > 0);
    assert_true(mixed < 1000.0 * (1 + s->head.n_offsets) / 5);
    free(near);
    ted4_scene_free(s);
}

static void weights(void **state)
{
    ted4_scene *const s = drawn_scene(5, 70);
    const double all = 32.0 * (double)s->netr.n;
    random_source r = random_seed(8);
    double coarse;

    (void)state;
    for (size_t i = 0; i < s->netr.n; i++)
        s->netr.values[i] = (float)(i % 7) / 7 + (i % 2 ? 0.1f : 1e-9f);
    assert_true(compact_netr(s) >= all);
    for (size_t i = 0; i < s->netr.n; i++)
        s->netr.values[i] = (float)(random_u32(&r) >> 29) / 8;
    coarse = compact_netr(s);
    assert_true(coarse < 0.15 * all && coarse > 8.0 * (double)s->shape.n_netr / 200);
    assert_true(coarse < 1.2 * compact_deflated(&s->netr));
    assert_true(compact_nete(s) < 18.0 * (double)s->nete.n);
    memset(s->nete.values, 0, s->nete.n * sizeof *s->nete.values);
    assert_true(compact_nete(s) < 0.2 * (double)s->nete.n + 8.0 * (double)s->shape.n_units);
    memset(s->bank.values, 0, s->bank.n * sizeof *s->bank.values);
    assert_true(compact_bank(s) < 0.1 * (double)s->bank.n + 50);
    ted4_scene_free(s);
}

static void positions(void **state)
{
    ted4_scene *const s = drawn_scene(6, 500);
    size_t shared;
    const double all = compact_octree(s, 16, &shared);

    (void)state;
    assert_int_equal(shared, 0);
    assert_true(all < 48.0 * 500);
    for (size_t i = 0; i < 1500; i++)
        s->position[i] = i < 3 ? 0x3c00 : 0xbc00; /* 1, and else -1 */
    assert_true(compact_octree(s, 12, &shared) < 200);
    assert_int_equal(shared, 498);
    s->position[0] = ted4_float_to_half(0.3f);
    s->position[1] = 0x3c00;
    compact_move_to_grid(s, 6);
    assert_true(ted4_half_to_float(s->position[0]) == 10 / 32.0f);
    assert_true(ted4_half_to_float(s->position[1]) == 31 / 32.0f);
    assert_true(ted4_half_to_float(s->position[3]) == -1.0f);
    ted4_scene_free(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(models), cmocka_unit_test(neighbours), cmocka_unit_test(causal),
        cmocka_unit_test(masks),  cmocka_unit_test(weights),    cmocka_unit_test(positions),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
