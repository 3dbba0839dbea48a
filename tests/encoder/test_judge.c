/* test_judge.c - train/step/stage_judge.c: who rests and for how long, what a level is, and that
 * steps are left out only where levels stand still.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "ball_group.h"
#include "test.h"
#include "train/monitor/checkpoint.h"
#include "train/state/picture.h"
#include "train/step/events.h"
#include "train/step/stage_judge.h"
#include "train/step/step.h"

/* Of these stages, windows are 140 steps and the rest of a round. */
enum { STAGE = 4800, WINDOW = 140, FIRST = STAGE / 10, GROUPS = TED4_JUDGE_GROUPS };

static ted4_train_options long_options(void)
{
    ted4_train_options o = ball_options();

    ball_set(&o, "stage1=4800");
    ball_set(&o, "stage2=4800");
    ball_set(&o, "probe=0");
    ball_set(&o, "judge=1");
    return o;
}

/* The same without learning: every level is that of the first picture. */
static ted4_train_options frozen_options(void)
{
    static const char *const rate[] = { "lr_feature=0", "lr_scaling=0", "lr_offset=0",
                                        "lr_phi=0",     "lr_tau=0",     "lr_mask=0",
                                        "lr_heads=0",   "lr_motion=0",  "lr_prior=0",
                                        "lr_colour=0",  "sprouts=0",    "poses=0",
                                        "grow_until=0", "activation=0", "dropout=0" };
    ted4_train_options o = long_options();

    for (size_t i = 0; i < sizeof rate / sizeof *rate; i++)
        ball_set(&o, rate[i]);
    return o;
}

static void one_step(ted4_trainer *t)
{
    if (ted4_trainer_step(t) != 0)
        fail_msg("%s", t->message.text);
}

/* Asserts that the sizes of groups of n pictures differ by one at most. */
static void check_sizes(const uint8_t *group, uint32_t n)
{
    unsigned size[GROUPS + 1] = { 0 };

    for (uint32_t i = 0; i < n; i++) {
        assert_in_range(group[i], 1, GROUPS);
        size[group[i]]++;
    }
    for (unsigned g = 1; g <= GROUPS; g++)
        assert_in_range(size[g], n / GROUPS, n / GROUPS + 1);
}

/* Groups of pictures at random where cameras are few. */
static void test_groups_of_pictures(void **state)
{
    const ted4_train_options o = long_options();
    unsigned other = 0;
    ted4_trainer t;

    (void)state;
    ball_begin(&t, &o, &balls, NULL);
    check_sizes(t.judge.group, t.order.n);
    for (uint32_t i = 0; i < t.order.n; i++)
        other += t.judge.group[i] != 1 + i % GROUPS;
    assert_int_not_equal(other, 0);
    ted4_trainer_finish(&t);
}

/* Whole cameras where there are eight: here each picture is said to be of one of nine. */
static void test_groups_of_cameras(void **state)
{
    enum { CAMERAS = 9 };
    const ted4_train_options o = long_options();
    const uint32_t cameras = balls.n_cameras;
    uint32_t was[64];
    ted4_trainer t;

    (void)state;
    assert_in_range(balls.n_pictures, 16, 64);
    for (uint32_t i = 0; i < balls.n_pictures; i++) {
        was[i] = balls.pictures[i].camera_id;
        balls.pictures[i].camera_id = i % CAMERAS;
    }
    balls.n_cameras = CAMERAS;
    ball_begin(&t, &o, &balls, NULL);
    check_sizes(t.judge.group, CAMERAS);
    for (uint32_t i = CAMERAS; i < t.order.n; i++)
        assert_int_equal(t.judge.group[i], t.judge.group[i - CAMERAS]);
    ted4_trainer_finish(&t);
    balls.n_cameras = cameras;
    for (uint32_t i = 0; i < balls.n_pictures; i++)
        balls.pictures[i].camera_id = was[i];
}

/* Nobody rests where pictures are too few, or where the option says so. */
static void test_off(void **state)
{
    ted4_train_options o = long_options();
    uint8_t was[64];
    ted4_trainer t;

    (void)state;
    ball_set(&o, "judge=0");
    ball_begin(&t, &o, &balls, NULL);
    assert_null(t.judge.group);
    ball_train(&t, FIRST + 2 * WINDOW);
    assert_int_equal(t.judge.state.turn, 0);
    assert_int_equal(t.order.rest, 0);
    ted4_trainer_finish(&t);
    ball_set(&o, "judge=1");
    for (uint32_t i = 0; i < balls.n_pictures; i++) {
        was[i] = balls.pictures[i].is_test;
        balls.pictures[i].is_test = i >= 15;
    }
    ball_begin(&t, &o, &balls, NULL);
    assert_int_equal(t.order.n, 15);
    assert_null(t.judge.group);
    ted4_trainer_finish(&t);
    for (uint32_t i = 0; i < balls.n_pictures; i++)
        balls.pictures[i].is_test = was[i];
}

/* Trains one step, and counts in seen[] the pictures that it took. */
static void count_step(ted4_trainer *t, unsigned *seen)
{
    one_step(t);
    seen[t->order.item[t->order.next - 1]]++;
}

/* The pictures of one group are not trained on during its window, and all others are, equally
 * often; the next window is that of the next group. No window begins before a tenth of the
 * stage. */
static void test_rest(void **state)
{
    const ted4_train_options o = long_options();
    unsigned seen[64] = { 0 }, rounds;
    ted4_trainer t;

    (void)state;
    ball_begin(&t, &o, &balls, NULL);
    ball_train(&t, FIRST - 1);
    assert_int_equal(t.judge.state.resting, 0);
    while (t.judge.state.resting == 0)
        one_step(&t);
    assert_in_range(t.iteration, FIRST, FIRST + t.order.n);
    assert_int_equal(t.judge.state.resting, 1);

    const uint64_t begin = t.iteration;

    while (t.judge.state.resting == 1)
        count_step(&t, seen);
    assert_int_equal(t.judge.state.resting, 2);
    assert_in_range(t.iteration - begin, WINDOW, WINDOW + t.order.n);
    assert_int_equal(t.judge.state.windows, 1);
    rounds = (unsigned)(t.iteration - begin) / (t.order.n - t.order.rest);
    for (uint32_t i = 0; i < t.order.n; i++)
        assert_int_equal(seen[i], t.judge.group[i] == 1 ? 0 : rounds);
    ted4_trainer_finish(&t);
}

/* A level is the loss of pictures that have rested; in stage 2 with that of the rate. A gain is the
 * share by which it is below the level of the same group before. */
static void test_level(void **state)
{
    const ted4_train_options o = long_options();
    const ted4_judge_state *s;
    double loss = 0, n = 0, before;
    ted4_trainer t;

    (void)state;
    ball_begin(&t, &o, &balls, NULL);
    s = &t.judge.state;
    while (s->windows == 0)
        one_step(&t);
    for (uint32_t i = 0; i < t.order.n; i++)
        if (t.judge.group[i] == 1) {
            loss += ted4_trainer_distortion(&t, i);
            n++;
        }
    before = s->level[0];
    assert_int_equal(s->last, 1);
    assert_true(fabs(before / (loss / n) - 1.0) < 1e-9);
    assert_true(s->gain[0] == 0);
    while (s->windows < GROUPS + 1)
        one_step(&t);
    assert_int_equal(s->last, 1);
    assert_int_equal(s->n, 1);
    assert_true(fabs(s->gain[0] - (1.0 - s->level[0] / before)) < 1e-12);
    ted4_trainer_finish(&t);
}

/* The rate is a part of the level of stage 2. */
static void test_level_of_stage2(void **state)
{
    ted4_train_options o = long_options();
    double loss = 0, n = 0, bits = 0;
    ted4_trainer t;

    (void)state;
    ball_set(&o, "stage1=100");
    ball_begin(&t, &o, &balls, NULL);
    t.judge.state.n = TED4_JUDGE_GROUPS; /* of stage 1, which stage 2 forgets */
    while (t.judge.state.windows == 0)
        one_step(&t);
    assert_true(t.phase.stage2);
    assert_int_equal(t.phase.left_out[1], 0);
    for (uint32_t i = 0; i < t.order.n; i++)
        if (t.judge.group[i] == t.judge.state.last) {
            loss += ted4_trainer_distortion(&t, i);
            n++;
        }
    for (int y = 0; y < TED4_TYPES; y++)
        bits += t.progress.bits[y];
    loss = loss / n + o.lambda * bits / ted4_rate_norm(&t);
    assert_true(bits > 0);
    assert_true(fabs(t.judge.state.level[t.judge.state.last - 1] / loss - 1.0) < 1e-9);
    ted4_trainer_finish(&t);
}

/* What does not learn stands still: the steps before the next event are left out, in both stages,
 * once each group has rested twice. */
static void test_stands_still(void **state)
{
    enum { TURN = GROUPS * WINDOW, MOST = GROUPS * 20 };
    const ted4_train_options o = frozen_options();
    ted4_trainer t;

    (void)state;
    ball_begin(&t, &o, &balls, NULL);
    while (t.phase.left_out[0] == 0)
        one_step(&t);
    assert_int_equal(t.judge.state.windows, 2 * GROUPS);
    assert_int_equal(t.judge.state.left_out, t.phase.left_out[0]);
    assert_in_range(t.iteration, FIRST + 2 * TURN, FIRST + 2 * (TURN + MOST));
    assert_int_equal(t.iteration + t.phase.left_out[0], 3120); /* closing of still anchors */
    while (!ted4_at_stage1_end(&t))
        one_step(&t);
    assert_int_equal(t.judge.state.windows, 3 * GROUPS);
    assert_int_equal(ted4_trainer_total(&t), t.iteration + STAGE);

    const uint64_t stage1 = t.iteration;

    one_step(&t);
    assert_true(t.phase.stage2);
    assert_int_equal(t.judge.state.resting, 0);
    assert_int_equal(t.phase.left_out[1], 0);
    while (t.phase.left_out[1] == 0)
        one_step(&t);
    assert_int_equal(t.judge.state.windows, 5 * GROUPS);
    assert_int_equal(ted4_stage_position(&t), 3840);
    assert_in_range(t.iteration - stage1, FIRST + 2 * TURN, FIRST + 2 * (TURN + MOST));
    one_step(&t);
    assert_true(t.phase.integer);
    ball_train(&t, ted4_trainer_total(&t));
    assert_int_equal(ted4_stage_position(&t), STAGE);
    assert_int_equal(t.judge.state.resting, 0);
    assert_int_equal(t.judge.state.windows, 5 * GROUPS);
    ted4_trainer_finish(&t);
}

/* What learns well goes on. */
static void test_improves(void **state)
{
    const ted4_train_options o = long_options();
    ted4_trainer t;

    (void)state;
    ball_begin(&t, &o, &balls, NULL);
    while (t.judge.state.windows < 2 * GROUPS)
        one_step(&t);
    assert_int_equal(t.phase.left_out[0], 0);
    ted4_trainer_finish(&t);
}

/* A training that goes on from a checkpoint within a window writes the same bytes. */
static void test_resumed(void **state)
{
    ted4_train_options o = long_options();
    ted4_snapshot s = { 0 };
    ball_file whole, resumed;
    ted4_trainer t;

    (void)state;
    ball_set(&o, "stage2=300");
    ball_begin(&t, &o, &balls, NULL);
    ball_train(&t, FIRST + 10 * WINDOW + 5);
    assert_int_not_equal(t.judge.state.resting, 0);
    assert_int_not_equal(t.order.rest, 0);
    assert_int_equal(ted4_snapshot_take(&t, &s), 0);
    whole = ball_finish(&t);
    ted4_trainer_finish(&t);
    ball_begin(&t, &o, &balls, NULL);
    assert_int_equal(ted4_snapshot_restore(&t, &s), 0);
    resumed = ball_finish(&t);
    ted4_trainer_finish(&t);
    ball_check_same(&whole, &resumed);
    ted4_snapshot_free(&s);
    free(whole.bytes);
    free(resumed.bytes);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_groups_of_pictures),
        cmocka_unit_test(test_groups_of_cameras),
        cmocka_unit_test(test_off),
        cmocka_unit_test(test_rest),
        cmocka_unit_test(test_level),
        cmocka_unit_test(test_level_of_stage2),
        cmocka_unit_test(test_stands_still),
        cmocka_unit_test(test_improves),
        cmocka_unit_test(test_resumed),
    };

    return cmocka_run_group_tests(tests, set_up, tear_down);
}
