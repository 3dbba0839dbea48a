/* test_static_test.c - train/search/static_test.c: time is kept if something moves and dropped if
 * nothing does, and the branch that is kept shows no effect of the test.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "test.h"
#include "ball_trainer.h"
#include "train/monitor/checkpoint.h"
#include "train/train.h"

/* Each branch takes 200 steps, from a quarter of stage 1 on. */
enum { STAGE1 = 2000, BEGIN = STAGE1 / 4, BRANCH = 200, FRAMES = 5 };

static ted4_train_options options(const char *probe)
{
    ted4_train_options o = ball_options();

    ball_set(&o, "stage1=2000");
    ball_set(&o, probe);
    return o;
}

/* Trains until just after the probe. */
static void train(ted4_trainer *t, ted4_dataset *d, const char *probe)
{
    const ted4_train_options o = options(probe);

    ball_begin(t, &o, d, NULL);
    ball_train(t, BEGIN + BRANCH + 1);
}

static void check_same(const ted4_trainer *a, const ted4_trainer *b)
{
    assert_int_equal(a->anchors.n, b->anchors.n);
    for (int k = 0; k < TED4_ROWS; k++)
        assert_memory_equal(a->anchors.data[k], b->anchors.data[k],
                            a->anchors.n_blocks * (size_t)a->anchors.rows[k] * TED4_LANES *
                                sizeof(float));
    assert_memory_equal(a->net.value, b->net.value, a->layout.n_net * sizeof *a->net.value);
    assert_memory_equal(a->net.v, b->net.v, a->layout.n_net * sizeof *a->net.v);
    assert_memory_equal(a->order.item, b->order.item, a->order.n * sizeof *a->order.item);
    assert_int_equal(a->order.next, b->order.next);
}

static void test_moving(void **state)
{
    tiny_folder folder;
    ted4_dataset d;
    ted4_trainer a, b;

    (void)state;
    ball_load(&folder, &d, FRAMES, 1);
    train(&a, &d, "probe=0.1");
    train(&b, &d, "probe=0");
    assert_true(a.search.probed);
    assert_true(a.search.probe_loss[0] > 0);
    assert_true(a.search.probe_loss[0] < 0.95 * a.search.probe_loss[1]);
    assert_true(b.search.probed);
    assert_true(b.search.probe_loss[0] == 0);
    assert_true(b.search.probe_loss[1] == 0);
    assert_int_equal(a.layout.head.motion, TED4_MOTION_BANK);
    assert_int_equal(a.layout.head.activation, 1);

    /* The branch that was kept equals the training without a probe. */
    assert_int_equal(a.iteration, b.iteration);
    assert_int_equal(a.anchors.n, b.anchors.n);
    check_same(&a, &b);
    ted4_trainer_finish(&a);
    ted4_trainer_finish(&b);
    ted4_dataset_free(&d);
    tiny_free(&folder);
}

/* The branch without time stops the clock for motion and for activation: if only one of them is
 * modelled, it is missed too. */
static void test_parts(void **state)
{
    static const char *const without[] = { "activation=0", "motion=0" };
    tiny_folder folder;
    ted4_dataset d;

    (void)state;
    ball_load(&folder, &d, FRAMES, 1);
    for (int i = 0; i < 2; i++) {
        ted4_train_options o = options("probe=0.1");
        ted4_trainer t;

        ball_set(&o, without[i]);
        ball_begin(&t, &o, &d, NULL);
        ball_train(&t, BEGIN + BRANCH + 1);
        /* The program's rule; usually it is a fifth. */
        if (!(t.search.probe_loss[0] > 0 && t.search.probe_loss[0] < 0.99 * t.search.probe_loss[1]))
            fail_msg("%s: %g with time, %g without", without[i], t.search.probe_loss[0],
                     t.search.probe_loss[1]);
        assert_int_equal(t.layout.head.motion, i == 0 ? TED4_MOTION_BANK : TED4_MOTION_NONE);
        assert_int_equal(t.layout.head.activation, i);
        ted4_trainer_finish(&t);
    }
    ted4_dataset_free(&d);
    tiny_free(&folder);
}

/* The parameters of motion do not learn, so neither branch can be much better than the other. If
 * they learn from a static scene, the branch with time may win by chance: with one seed in eight
 * its loss is 2 % lower. */
static void test_still(void **state)
{
    tiny_folder folder;
    ted4_dataset d;
    ted4_trainer t, twin;
    ted4_snapshot early = { 0 };
    ted4_train_options o = options("probe=0.1");

    (void)state;
    ball_set(&o, "lr_motion=0");
    ball_set(&o, "lr_phi=0");
    ball_set(&o, "lr_tau=0");
    ball_load(&folder, &d, FRAMES, 0);
    ball_begin(&t, &o, &d, NULL);
    ball_train(&t, BEGIN);
    assert_int_equal(ted4_trainer_step(&t), 0);
    assert_true(t.search.probed);
    assert_true(t.search.probe_loss[0] > 0.99 * t.search.probe_loss[1]);
    assert_int_equal(t.iteration, 1);
    assert_int_equal(t.layout.head.motion, TED4_MOTION_NONE);
    assert_int_equal(t.layout.head.temporal_mask, 0);
    assert_int_equal(t.layout.head.activation, 0);
    assert_int_equal(t.layout.shape.n_bank, 0);
    assert_int_equal(t.phase.clock_stopped, 0);
    assert_int_equal(ted4_snapshot_take(&t, &early), 0);
    ball_train(&t, BEGIN + BRANCH + 1);

    /* A run that was killed after it had started again continues without time, and does not repeat
     * the test. */
    ball_begin(&twin, &o, &d, NULL);
    if (ted4_snapshot_restore(&twin, &early) != 0)
        fail_msg("%s", twin.message.text);
    assert_int_equal(twin.iteration, 1);
    assert_int_equal(twin.layout.head.motion, TED4_MOTION_NONE);
    ball_train(&twin, BEGIN + BRANCH + 1);
    check_same(&t, &twin);
    ted4_trainer_finish(&twin);
    ted4_snapshot_free(&early);

    /* What follows equals the training of an encoder without time. */
    ball_set(&o, "motion=0");
    ball_set(&o, "activation=0");
    ball_begin(&twin, &o, &d, NULL);
    ball_train(&twin, BEGIN + BRANCH + 1);
    check_same(&t, &twin);
    ted4_trainer_finish(&t);
    ted4_trainer_finish(&twin);
    ted4_dataset_free(&d);
    tiny_free(&folder);
}

/* With too few steps, nothing is tested. */
static void test_short(void **state)
{
    tiny_folder folder;
    ted4_dataset d;
    ted4_trainer t;

    (void)state;
    ball_load(&folder, &d, FRAMES, 0);
    train(&t, &d, "probe=0.09");
    assert_true(t.search.probed);
    assert_true(t.search.probe_loss[0] == 0);
    assert_int_equal(t.layout.head.motion, TED4_MOTION_BANK);
    ted4_trainer_finish(&t);
    ted4_dataset_free(&d);
    tiny_free(&folder);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_moving),
        cmocka_unit_test(test_parts),
        cmocka_unit_test(test_still),
        cmocka_unit_test(test_short),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
