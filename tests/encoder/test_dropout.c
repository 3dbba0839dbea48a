/* test_dropout.c - train/state/dropout.c: how much is left out of a step, what, and that nothing is
 * left out elsewhere.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <math.h>
#include <stdlib.h>

#include "ball_group.h"
#include "test.h"
#include "train/state/dropout.h"
#include "train/state/picture.h"
#include "train/state/visible_blocks.h"

enum { GROUP = TED4_LANES / 2, STEPS = 400 };

static void check_share(const ted4_trainer *t, double share)
{
    assert_true(fabs(ted4_dropout_share(t) - share) < 1e-12);
}

/* The share by cameras, step and phase. */
static void test_share(void **state)
{
    ted4_trainer t = { .opt = { .stage1 = 1000, .dropout = 0.4 }, .order = { .cameras = 1 } };

    (void)state;
    check_share(&t, 0);
    t.iteration = 500;
    check_share(&t, 0.2);
    t.iteration = 1000;
    check_share(&t, 0.4);
    t.order.cameras = 6;
    check_share(&t, 0.4);
    t.order.cameras = 9;
    assert_true(fabs(ted4_dropout_most(&t) - 0.2) < 1e-12);
    check_share(&t, 0.2);
    t.order.cameras = 12;
    check_share(&t, 0);
    t.order.cameras = 100;
    check_share(&t, 0);
    t.order.cameras = 1;
    t.phase.stage2 = 1;
    check_share(&t, 0);
}

/* Cameras per time: of the training split, and over the times that it shows. */
static void test_cameras(void **state)
{
    ted4_train_options o = ball_options();
    size_t training = 0, of_frame_2 = 0;
    ted4_trainer t;

    (void)state;
    for (size_t i = 0; i < balls.n_pictures; i++)
        training += !balls.pictures[i].is_test;
    ball_begin(&t, &o, &balls, NULL);
    assert_true(t.order.cameras == (double)training / FRAMES);
    ted4_trainer_finish(&t);
    for (size_t i = 0; i < balls.n_pictures; i++)
        if (!balls.pictures[i].is_test && balls.pictures[i].frame == 2) {
            balls.pictures[i].is_test = 1;
            of_frame_2++;
        }
    ball_begin(&t, &o, &balls, NULL);
    assert_true(of_frame_2 > 0);
    assert_true(t.order.cameras == (double)(training - of_frame_2) / (FRAMES - 1));
    ted4_trainer_finish(&t);
}

/* Asserts that the list is what is left of all blocks, in groups, and that every array says so.
 * Counts in left[] the steps in which a group was there, and returns the number of groups here. */
static unsigned check_list(const ted4_trainer *t, unsigned *left)
{
    const ted4_visible_blocks *s = &t->visible_blocks;
    unsigned groups = 0;

    for (size_t i = 0; i < s->n; i++) {
        const size_t b = s->block[i];
        const uint32_t all = ted4_block_lanes(&t->anchors, b);

        assert_true(i == 0 || b > s->block[i - 1]);
        assert_int_not_equal(s->lanes[i], 0);
        assert_ptr_equal(s->position[i], ted4_block(&t->anchors, TED4_ROW_POSITION, b));
        assert_ptr_equal(s->raw[i], ted4_block(&t->anchors, TED4_ROW_VALUE, b));
        assert_ptr_equal(s->used[i], s->raw[i]);
        assert_ptr_equal(s->steps[i], ted4_block(&t->anchors, TED4_ROW_STEP, b));
        for (size_t k = 0; k < TED4_LANES / GROUP; k++) {
            const uint32_t of_group = all & ((((uint32_t)1 << GROUP) - 1) << k * GROUP);
            const uint32_t here = s->lanes[i] & of_group;

            assert_true(here == 0 || here == of_group);
            left[b * (TED4_LANES / GROUP) + k] += here != 0;
            groups += here != 0;
        }
    }
    return groups;
}

/* Groups are left out with the right probability, independently of each other and of the step
 * before, and the same ones whenever the step is repeated. */
static void test_groups(void **state)
{
    ted4_train_options o = ball_options();
    unsigned left[64] = { 0 }, twice[64] = { 0 }, same = 0;
    ted4_trainer t;
    double total = 0;

    (void)state;
    ball_set(&o, "dropout=0.5");
    ball_begin(&t, &o, &balls, NULL);

    const size_t groups = (t.anchors.n + GROUP - 1) / GROUP;
    unsigned before = 0;

    assert_in_range(groups, 4, 64);
    t.opt.stage1 = STEPS;
    for (t.iteration = STEPS - 100; t.iteration < STEPS; t.iteration++) {
        assert_int_equal(ted4_visible_blocks_fill(&t, NULL), 0);
        ted4_dropout(&t);

        const unsigned n = check_list(&t, left);

        same += n == before;
        before = n;
        total += n;
        assert_int_equal(ted4_visible_blocks_fill(&t, NULL), 0);
        ted4_dropout(&t);
        assert_int_equal(check_list(&t, twice), n);
    }
    /* The share grows from 0.375 to 0.5; the mean of 100 times groups coins, within 4 sigma. */
    const double trials = 100.0 * (double)groups;

    assert_true(fabs(total / trials - (1 - 0.4375)) < 4 * sqrt(0.25 / trials));
    for (size_t g = 0; g < groups; g++)
        assert_in_range(left[g], 56 - 25, 56 + 25); /* 5 sigma */
    assert_true(same < 60);
    ted4_trainer_finish(&t);
}

/* Steps leave anchors out; what judges the model does not, and neither does stage 2. */
static void test_only_steps(void **state)
{
    ted4_train_options o = ball_options();
    ted4_generate_input in;
    ted4_trainer t;
    ted4_splats s;
    ted4_view v;

    (void)state;
    ball_set(&o, "dropout=0.9");
    ball_begin(&t, &o, &balls, NULL);
    t.iteration = (uint64_t)o.stage1 - 1;
    assert_int_equal(ted4_trainer_render(&t, &balls.pictures[0], TED4_PASS_IMAGE, &v, &in, &s), 0);

    const size_t all = s.n;

    assert_int_equal(ted4_trainer_render(&t, &balls.pictures[0], TED4_PASS_STEP, &v, &in, &s), 0);
    assert_true(s.n < all);
    t.opt.dropout = 0;
    assert_int_equal(ted4_trainer_render(&t, &balls.pictures[0], TED4_PASS_STEP, &v, &in, &s), 0);
    assert_int_equal(s.n, all);
    ted4_trainer_finish(&t);
}

/* Loads the scene again, for a test that changes it. */
static int load_again(void **state)
{
    tear_down(state);
    return set_up(state);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_share),
        cmocka_unit_test(test_groups),
        cmocka_unit_test(test_only_steps),
        cmocka_unit_test_setup_teardown(test_cameras, load_again, load_again),
    };

    return cmocka_run_group_tests_name("dropout", tests, set_up, tear_down);
}
