/* test_nan.c - a model value that is not finite never reaches a checkpoint, and the last checkpoint
 * still leads to the same result. A loss that is not finite ends the training before it affects the
 * model.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "test.h"
#include "ball_trainer.h"
#include "train/monitor/checkpoint.h"
#include "train/monitor/monitor.h"
#include "train/train.h"

/* A value becomes infinite or NaN between two checks: no checkpoint is made of it, and the last one
 * is unchanged and leads to the same result. */
static void test_nan(void **state)
{
    const ted4_train_options o = ball_options();
    tiny_folder f;
    ted4_dataset d;
    ted4_trainer t;
    ball_file whole, again;

    (void)state;
    ball_load(&f, &d, 5, 1);
    for (int which = 0; which < 2; which++) {
        char path[512];

        snprintf(path, sizeof path, "%s", tiny_path(&f, "checkpoint"));
        ball_begin(&t, &o, &d, NULL);
        ball_train(&t, 130);
        assert_int_equal(ted4_checkpoint_save(&t, path), 0);
        whole = ball_finish(&t);
        ted4_trainer_finish(&t);

        ball_begin(&t, &o, &d, NULL);
        assert_int_equal(ted4_checkpoint_load(&t, path), 0);
        if (which == 0)
            t.net.value[t.layout.netr + 1] = NAN;
        else
            *ted4_anchor_value(&t.anchors, TED4_ROW_VALUE, 3, 0) = INFINITY;
        assert_int_equal(ted4_checkpoint_save(&t, path), -1);
        assert_non_null(strstr(t.message.text, "not finite at step 130"));
        ted4_monitor_forget(&t); /* else the step goes back (test_monitor.c) */
        assert_int_equal(ted4_trainer_step(&t), -1);
        assert_non_null(
            strstr(t.message.text, "not finite at step 130; there is no good state before it"));
        assert_int_equal(ted4_checkpoint_save(&t, path), -1);
        ted4_trainer_finish(&t);

        ball_begin(&t, &o, &d, NULL);
        assert_int_equal(ted4_checkpoint_load(&t, path), 0);
        assert_int_equal(t.iteration, 130);
        again = ball_finish(&t);
        ted4_trainer_finish(&t);
        ball_check_same(&whole, &again);
        free(whole.bytes);
        free(again.bytes);
    }
    ted4_dataset_free(&d);
    tiny_free(&f);
}

static void spoil_colour(ted4_trainer *t)
{
    assert_true(t->colour.n_corrected > 0);
    for (uint32_t c = 0; c < t->colour.n_cameras; c++)
        t->colour.value[c][0] = NAN;
}

static void spoil_poses(ted4_trainer *t)
{
    assert_true(t->poses.n > 0);
    t->poses.value[t->poses.n - 1][TED4_POSE_VALUES - 1] = NAN;
}

/* A NaN in what belongs to cameras is detected before a step changes networks or anchors. */
static void check_spoiled(void (*spoil)(ted4_trainer *), const char *what)
{
    const ted4_train_options o = ball_options();
    tiny_folder f;
    ted4_dataset d;
    ted4_trainer t;
    float *net;

    ball_load(&f, &d, 5, 1);
    ball_begin(&t, &o, &d, NULL);
    ball_train(&t, 130);
    spoil(&t);
    net = malloc(t.layout.n_net * sizeof *net);
    assert_non_null(net);
    memcpy(net, t.net.value, t.layout.n_net * sizeof *net);
    ted4_monitor_forget(&t);
    assert_int_equal(ted4_trainer_step(&t), -1);
    assert_non_null(strstr(t.message.text, what));
    assert_non_null(
        strstr(t.message.text, "not finite at step 130; there is no good state before it"));
    assert_int_equal(t.iteration, 130);
    assert_memory_equal(net, t.net.value, t.layout.n_net * sizeof *net);
    assert_int_equal(ted4_trainer_check(&t, 1), -1);
    free(net);
    ted4_trainer_finish(&t);
    ted4_dataset_free(&d);
    tiny_free(&f);
}

static void test_colour(void **state)
{
    (void)state;
    check_spoiled(spoil_colour, "map of colour");
}

static void test_poses(void **state)
{
    (void)state;
    check_spoiled(spoil_poses, "motion of pose");
}

int main(void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test(test_nan), cmocka_unit_test(test_colour),
                                        cmocka_unit_test(test_poses) };

    return cmocka_run_group_tests_name("nan", tests, NULL, NULL);
}
