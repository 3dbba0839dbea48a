/* test_stage1.c - one state from the end of stage 1 serves every lambda and every variant of stage
 * 2: the result equals that of a complete training.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "test.h"
#include "ball_trainer.h"
#include "train/monitor/checkpoint.h"

enum { STAGE1 = 400, FRAMES = 5 };

static tiny_folder folder;
static ted4_dataset scene;
static ted4_snapshot shared;

static int set_up(void **state)
{
    const ted4_train_options o = ball_options();
    ted4_trainer t;

    (void)state;
    ball_load(&folder, &scene, FRAMES, 1);
    ball_begin(&t, &o, &scene, NULL);
    ball_train(&t, STAGE1);
    assert_int_equal(ted4_snapshot_take(&t, &shared), 0);
    ted4_trainer_finish(&t);
    return 0;
}

static int tear_down(void **state)
{
    (void)state;
    ted4_snapshot_free(&shared);
    ted4_dataset_free(&scene);
    tiny_free(&folder);
    return 0;
}

static ball_file train(const ted4_train_options *o, int from_shared)
{
    ted4_trainer t;
    ball_file f;

    ball_begin(&t, o, &scene, NULL);
    if (from_shared && ted4_snapshot_restore(&t, &shared) != 0)
        fail_msg("%s", t.message.text);
    assert_int_equal(t.iteration, from_shared ? STAGE1 : 0);
    f = ball_finish(&t);
    ted4_trainer_finish(&t);
    return f;
}

static const char *const variants[] = {
    "lambda=0.02",      "stage2=120",     "slices=1",  "factorised=1",   "offset_mask=0",
    "step_feature=0.5", "hyper_layers=0", "octaves=0", "linear_scale=1", "integer_share=0.5",
};

static void test_variants(void **state)
{
    ball_file base;

    (void)state;
    ted4_train_options o = ball_options();

    base = train(&o, 1);
    for (size_t i = 0; i < sizeof variants / sizeof variants[0]; i++) {
        o = ball_options();
        ball_set(&o, variants[i]);
        if (i == 8)
            ball_set(&o, "step_scaling=0.001");

        const ball_file whole = train(&o, 0), quick = train(&o, 1);

        ball_check_same(&whole, &quick);
        if (whole.size == base.size && memcmp(whole.bytes, base.bytes, base.size) == 0)
            fail_msg("%s makes no difference", variants[i]);
        free(whole.bytes);
        free(quick.bytes);
    }
    free(base.bytes);
}

/* Options of stage 1 must be the same, and a state from stage 2 belongs to one lambda. */
static void test_refused(void **state)
{
    static const char *const bad[] = { "motion=2", "view=0", "temporal_weight=0.1", "stage1=401" };
    ted4_train_options o;
    ted4_trainer t;
    ted4_snapshot later = { 0 };

    (void)state;
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        o = ball_options();
        ball_set(&o, bad[i]);
        ball_begin(&t, &o, &scene, NULL);
        assert_int_equal(ted4_snapshot_restore(&t, &shared), -1);
        ted4_trainer_finish(&t);
    }
    o = ball_options();
    ball_begin(&t, &o, &scene, NULL);
    assert_int_equal(ted4_snapshot_restore(&t, &shared), 0);
    ball_train(&t, STAGE1 + 1);
    assert_int_equal(ted4_snapshot_take(&t, &later), 0);
    t.opt.lambda *= 2;
    assert_int_equal(ted4_snapshot_restore(&t, &later), -1);
    ted4_trainer_finish(&t);
    ted4_snapshot_free(&later);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_variants),
        cmocka_unit_test(test_refused),
    };

    return cmocka_run_group_tests(tests, set_up, tear_down);
}
