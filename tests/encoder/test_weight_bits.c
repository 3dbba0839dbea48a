/* test_weight_bits.c - train/search/weight_bits.c in a whole training: with a fixed capacity, the
 * weights of profile Compact are as coarse as the cost of the file wants, and nothing else of the
 * model changes. In profile Main, and where trials cannot be paid for, weights keep all bits.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "ball_trainer.h"
#include "test.h"
#include "train/search/file_cost.h"
#include "train/search/weight_bits.h"

enum { FRAMES = 3, STAGE1 = 60, STAGE2 = 2800, INTEGER = STAGE1 + STAGE2 * 4 / 5 };

static tiny_folder folder;
static ted4_dataset scene;

static ted4_train_options options(const char *profile)
{
    ted4_train_options o = ball_options();

    ball_set(&o, profile);
    ball_set(&o, "capacity=0");
    ball_set(&o, "capacity_share=0.25");
    ball_set(&o, "integer_share=0.2");
    ball_set(&o, "stage1=60");
    ball_set(&o, "stage2=2800");
    ball_set(&o, "lambda=0.0003");
    return o;
}

static int is_full(const ted4_trainer *t)
{
    int full = 1;

    for (int g = 0; g < TED4_WEIGHT_GRIDS; g++)
        full &= t->net.bits[g] == TED4_WEIGHT_GRID_FULL(g);
    return full;
}

/* Trials in order: each makes one grid coarser, and is taken if and only if the file then costs
 * less than with the best setting before. */
static void check_trials(const ted4_trainer *t)
{
    int bits[TED4_WEIGHT_GRIDS];
    double cost = 0;

    ted4_weight_grid_full(bits);
    assert_true(t->search.n_trials >= 4);
    for (size_t i = 0; i < t->search.n_trials; i++) {
        const struct ted4_trial *x = &t->search.trial[i];
        const int grid = (int)x->candidate - TED4_CANDIDATE_HEAD_BITS;

        assert_true(grid >= 0 && grid < TED4_WEIGHT_GRIDS);
        assert_int_equal(x->from, bits[grid]);
        assert_true(x->to < x->from);
        assert_true(x->steps == 0);
        assert_int_equal(x->taken, x->after.cost < x->before.cost);
        assert_true(i == 0 || !(x->before.cost != cost));
        cost = x->taken ? x->after.cost : x->before.cost;
        if (x->taken)
            bits[grid] = (int)x->to;
    }
    for (int g = 0; g < TED4_WEIGHT_GRIDS; g++)
        assert_int_equal(t->net.bits[g], bits[g]);
}

static void test_compact(void **state)
{
    const ted4_train_options o = options("profile=1");
    ted4_trainer t;
    ted4_cost before, after;

    (void)state;
    ball_begin(&t, &o, &scene, NULL);
    ball_train(&t, INTEGER);
    assert_false(t.phase.integer);
    assert_true(is_full(&t));
    assert_int_equal(t.search.n_trials, 0);

    const ted4_layout layout = t.layout;

    assert_int_equal(ted4_file_cost(&t, &before), 0);
    ball_train(&t, INTEGER + 1); /* train.c asks */
    assert_true(t.phase.integer);
    assert_int_equal(t.search.decided, TED4_DECIDED_ALL);
    check_trials(&t);
    assert_true(t.net.bits[TED4_WEIGHT_GRID_HEADS] <= 12);
    assert_int_equal(t.layout.n_net, layout.n_net);
    assert_int_equal(ted4_file_cost(&t, &after), 0);
    assert_true(after.bytes < 0.9 * before.bytes);
    ball_train(&t, STAGE1 + STAGE2);
    ted4_trainer_finish(&t);
}

static void test_not_asked(void **state)
{
    (void)state;
    for (int k = 0; k < 3; k++) {
        ted4_train_options o = options(k == 0 ? "profile=0" : "profile=1");
        ted4_trainer t;

        if (k == 1)
            ball_set(&o, "capacity=1");
        if (k == 2)
            ball_set(&o, "capacity_share=0.01");
        ball_begin(&t, &o, &scene, NULL);
        assert_true(!(ted4_coarsen_weights_steps(&t) > 0));
        if (k != 1)
            ball_train(&t, INTEGER + 1);
        assert_true(is_full(&t));
        assert_int_equal(t.search.n_trials, 0);
        ted4_trainer_finish(&t);
    }
}

static int set_up(void **state)
{
    (void)state;
    ball_load(&folder, &scene, FRAMES, 1);
    return 0;
}

static int tear_down(void **state)
{
    (void)state;
    ted4_dataset_free(&scene);
    tiny_free(&folder);
    return 0;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_compact),
        cmocka_unit_test(test_not_asked),
    };

    return cmocka_run_group_tests(tests, set_up, tear_down);
}
