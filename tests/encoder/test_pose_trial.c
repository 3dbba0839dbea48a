/* test_pose_trial.c - train/step/pose_step.c: the trial of refinement, which puts right poses back.
 * Poses that are wrong: test_poses.c.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <math.h>

#include "ball_group.h"
#include "pose_training.h"
#include "test.h"
#include "train/model/normalise.h"
#include "train/state/picture.h"
#include "train/step/pose_step.h"

/* Right poses are put back: from then on all views are those of the given cameras, and nothing
 * learns. */
static void test_right(void **state)
{
    const ted4_train_options o = pose_options();
    ted4_trainer t;
    ted4_view v, given;
    float centre[3];
    uint64_t steps = 0;

    (void)state;
    ball_begin(&t, &o, &balls, NULL);
    assert_int_equal(t.poses.n, BALL_CAMERAS);
    ball_train(&t, FREE);
    assert_int_equal(t.poses.decision, TED4_POSES_ON_TRIAL);
    for (size_t i = 0; i < t.poses.n; i++)
        steps += t.poses.steps[i];
    assert_int_equal(steps, FREE);
    assert_true(fabsf(t.poses.value[0][0]) > 0);
    assert_true(t.monitor.norm[TED4_TERM_POSE] > 0);
    ball_train(&t, FREE + 10);
    assert_int_equal(t.poses.decision, TED4_POSES_GIVEN);
    assert_true(t.poses.moved > 0);
    assert_true(t.poses.moved < 0.2);
    assert_true(t.monitor.norm[TED4_TERM_POSE] == 0);
    for (size_t i = 0; i < balls.n_pictures; i++) {
        ted4_trainer_view(&t, &balls.pictures[i], &v, centre);
        ted4_normalise_view(&t.layout.head, &balls.pictures[i].camera, &given, centre);
        assert_memory_equal(v.R, given.R, sizeof v.R);
        assert_memory_equal(v.t, given.t, sizeof v.t);
    }
    for (size_t i = 0; i < t.poses.n; i++)
        for (int k = 0; k < TED4_POSE_VALUES; k++)
            assert_true(t.poses.value[i][k] == 0);
    ted4_trainer_finish(&t);
}

static void test_off(void **state)
{
    ted4_train_options o = pose_options();
    ted4_trainer t;

    (void)state;
    ball_set(&o, "poses=0");
    ball_begin(&t, &o, &balls, NULL);
    assert_int_equal(t.poses.n, 0);
    ball_train(&t, DECIDED + 1);
    assert_int_equal(t.poses.decision, TED4_POSES_ON_TRIAL);
    assert_true(t.monitor.norm[TED4_TERM_POSE] == 0);
    ted4_trainer_finish(&t);
}

/* Pictures by cameras that stand still, by cameras that move, and all of one time. */
enum { STILL, MOVING, ONE_TIME, KINDS };

/* Loads them. Moving cameras, each picture of which has a pose of its own, differ from still ones
 * by too little to matter otherwise. */
static void load_kind(int kind, tiny_folder *f, ted4_dataset *d)
{
    ball_load(f, d, kind == ONE_TIME ? 1 : FRAMES, 1);
    for (size_t i = 0; i < d->n_pictures; i++)
        if (kind == MOVING)
            d->pictures[i].camera.t[0] += 1e-6 * d->pictures[i].frame;
}

static size_t training_pictures(const ted4_dataset *d)
{
    size_t n = 0;

    for (size_t i = 0; i < d->n_pictures; i++)
        n += !d->pictures[i].is_test;
    return n;
}

/* Turns all cameras aside by the same angle, which no motion of the scene can hide: its points move
 * by the focal length times the angle, and a little more beside the centre. Then decides, and
 * expects that decision. */
static void decide(ted4_trainer *t, double pixels, uint64_t step, ted4_poses_decision want)
{
    for (size_t i = 0; i < t->poses.n; i++)
        t->poses.value[i][1] = (float)(pixels / BALL_FOCAL);
    t->iteration = step;
    ted4_poses_decide(t);
    assert_int_equal(t->poses.decision, want);
}

static void check_moved(const ted4_trainer *t, double pixels)
{
    assert_true(t->poses.moved > pixels);
    assert_true(t->poses.moved < 1.15 * pixels);
}

/* Of poses that have moved far, half a pixel suffices. */
static void test_far(void **state)
{
    const ted4_train_options o = pose_options();

    (void)state;
    for (int wrong = 0; wrong < 2; wrong++) {
        ted4_trainer t;

        ball_begin(&t, &o, &balls, NULL);
        decide(&t, 1.0, FREE, TED4_POSES_WITH_PRIOR);
        decide(&t, wrong ? 0.51 : 0.43, DECIDED, wrong ? TED4_POSES_REFINED : TED4_POSES_GIVEN);
        ted4_trainer_finish(&t);
    }
}

/* Poses have to move farther if each belongs to one picture in which things may move, and most of
 * it has to remain with the prior. */
static void test_limits(void **state)
{
    static const double limit[KINDS] = { 0.2, 0.5, 0.2 };
    const ted4_train_options o = pose_options();

    (void)state;
    for (int kind = 0; kind < KINDS; kind++)
        for (int wrong = 0; wrong < 3; wrong++) {
            const double freely = (wrong == 0 ? 0.85 : 1.01) * limit[kind];
            const double remains = (wrong == 1 ? 0.7 : 0.8) * freely;
            tiny_folder f;
            ted4_dataset d;
            ted4_trainer t;

            load_kind(kind, &f, &d);
            ball_begin(&t, &o, &d, NULL);
            assert_int_equal(t.poses.n, kind == MOVING ? training_pictures(&d) : BALL_CAMERAS);
            decide(&t, freely, FREE - 1, TED4_POSES_ON_TRIAL);
            decide(&t, freely, FREE, wrong > 0 ? TED4_POSES_WITH_PRIOR : TED4_POSES_GIVEN);
            check_moved(&t, freely);
            assert_int_equal(ted4_poses_on_trial(&t.poses), wrong > 0);
            if (wrong > 0) {
                decide(&t, remains, DECIDED - 1, TED4_POSES_WITH_PRIOR);
                decide(&t, remains, DECIDED, wrong > 1 ? TED4_POSES_REFINED : TED4_POSES_GIVEN);
                check_moved(&t, remains);
            }
            ted4_trainer_finish(&t);
            ted4_dataset_free(&d);
            tiny_free(&f);
        }
}

/* The prior, and nothing else, pulls poses of which pictures say nothing: in the second part of the
 * trial only, towards the given poses, twice as much from twice as far. */
static void test_prior(void **state)
{
    const ted4_train_options o = pose_options();

    (void)state;
    for (int decision = TED4_POSES_ON_TRIAL; decision <= TED4_POSES_REFINED; decision++) {
        ted4_trainer t;

        ball_begin(&t, &o, &balls, NULL);
        t.poses.decision = (ted4_poses_decision)decision;
        t.poses.seen[1] = 1;
        t.poses.value[1][0] = 0.25f / (float)BALL_FOCAL;
        t.poses.value[1][4] = -0.5f / (float)BALL_FOCAL;
        ted4_update_poses(&t);
        if (decision == TED4_POSES_WITH_PRIOR) {
            assert_true(t.poses.m[1][0] > 0);
            assert_float_equal(t.poses.m[1][4] / t.poses.m[1][0], -2, 1e-6);
            assert_true(t.poses.value[1][0] < 0.25f / (float)BALL_FOCAL);
        } else {
            assert_true(t.poses.m[1][0] == 0);
        }
        assert_true(t.poses.m[1][1] == 0);
        assert_true(t.monitor.norm[TED4_TERM_POSE] == 0);
        ted4_trainer_finish(&t);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_right), cmocka_unit_test(test_off),   cmocka_unit_test(test_limits),
        cmocka_unit_test(test_far),   cmocka_unit_test(test_prior),
    };

    return cmocka_run_group_tests_name("pose_trial", tests, set_up, tear_down);
}
