/* test_monitor.c - train/monitor/monitor.c and train/monitor/grad_norm.c: anomalies are detected
 * when they occur and named; training goes back to the last good state and continues with smaller
 * steps, up to three times; healthy trainings are not affected. Files and logs of a program that
 * went back: test_run_log.c.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "test.h"
#include "ball_trainer.h"
#include "train/monitor/checkpoint.h"
#include "train/monitor/grad_norm.h"
#include "train/monitor/monitor.h"
#include "train/monitor/rollback.h"
#include "train/monitor/scale.h"
#include "train/step/picture_order.h"
#include "train/step/schedule.h"
#include "train/train.h"

/* States are kept at the start, at step 250 and at the end of stage 1. */
enum { STAGE1 = 400, INTEGER_FROM = 600, KEPT = 250, FRAMES = 5 };

static tiny_folder folder, still_folder;
static ted4_dataset scene, still;

static int set_up(void **state)
{
    (void)state;
    ball_load(&folder, &scene, FRAMES, 1);
    ball_load(&still_folder, &still, FRAMES, 0);
    return 0;
}

static int tear_down(void **state)
{
    (void)state;
    ted4_dataset_free(&scene);
    ted4_dataset_free(&still);
    tiny_free(&folder);
    tiny_free(&still_folder);
    return 0;
}

static void begin_at(ted4_trainer *t, uint64_t iteration)
{
    const ted4_train_options o = ball_options();

    ball_begin(t, &o, &scene, NULL);
    ball_train(t, iteration);
}

/* ---- the usual magnitude ---- */

static void test_scale(void **state)
{
    ted4_scale s = { 0 };

    (void)state;
    assert_true(ted4_scale_usual(&s) == 0);
    assert_true(ted4_scale_take(&s, 0) == 0);
    assert_int_equal(s.n, 0);
    for (int i = 0; i < 100; i++)
        assert_true(ted4_scale_take(&s, i % 2 ? 3.0 : 1.0) == 0);
    assert_int_equal(s.n, 100);
    assert_true(s.peak == 0);
    assert_true(ted4_scale_usual(&s) > 0.7);
    assert_true(ted4_scale_usual(&s) < 4.3);
    for (int i = 0; i < 300; i++)
        (void)ted4_scale_take(&s, i % 20 ? 2.0 : 2e9);
    assert_true(ted4_scale_usual(&s) > 1.9);
    assert_true(ted4_scale_usual(&s) < 2.1);
    assert_true(fabs(ted4_scale_take(&s, 2e9) / 1e9 - 1) < 0.1);
    assert_true(s.peak > 9e8);
    assert_true(ted4_scale_usual(&s) < 2.2);
}

/* ---- healthy trainings ---- */

/* The file does not depend on how often states are kept. */
static void test_healthy(void **state)
{
    ted4_trainer t;
    ball_file plain, kept;

    (void)state;
    begin_at(&t, 0);
    plain = ball_finish(&t);
    assert_int_equal(t.monitor.state.rollbacks, 0);
    assert_true(t.monitor.state.factor == 1);
    assert_null(t.monitor.anomaly.cause);
    for (int k = 0; k < TED4_TERMS; k++) {
        assert_true(t.monitor.state.gradient[k].peak < 100);
        /* The poses are right, so they are not refined in the end. */
        assert_int_equal((t.monitor.norm[k] > 0),
                         (k != TED4_TERM_PRIOR && k != TED4_TERM_STEP && k != TED4_TERM_POSE));
    }
    ted4_trainer_finish(&t);
    begin_at(&t, 0);
    while (t.iteration < ted4_trainer_total(&t)) {
        ted4_monitor_forget(&t);
        assert_int_equal(ted4_trainer_step(&t), 0);
    }
    kept = ball_finish(&t);
    ted4_trainer_finish(&t);
    ball_check_same(&plain, &kept);
    free(plain.bytes);
    free(kept.bytes);
}

/* ---- what is detected ---- */

/* Asserts that the next step goes back to the state at step to, for this cause. */
static void expect_back(ted4_trainer *t, uint64_t to, const char *cause, const char *term,
                        int64_t anchor)
{
    const ted4_anomaly *f = &t->monitor.anomaly;
    const uint64_t at = t->iteration, rollbacks = t->monitor.state.rollbacks;
    const double factor = t->monitor.state.factor;
    char words[64];

    if (ted4_trainer_step(t) != 0)
        fail_msg("%s", t->message.text);
    if (strcmp(f->cause, cause) != 0 || strcmp(f->term, term) != 0 || f->anchor != anchor ||
        f->step != at)
        fail_msg("%s, %s, %d, %d: %s", f->cause, f->term, (int)f->anchor, (int)f->step,
                 t->message.text);
    snprintf(words, sizeof words, "at step %d", (int)at);
    assert_non_null(strstr(t->message.text, words));
    assert_non_null(strstr(t->message.text, term));
    assert_int_equal(t->iteration, to);
    assert_int_equal(t->monitor.state.rollbacks, rollbacks + 1);
    assert_true(t->monitor.state.factor == 0.5 * factor);
    assert_true(!t->monitor.found);
}

static void finish(ted4_trainer *t)
{
    ball_file f = ball_finish(t);

    assert_true(f.size > 500);
    assert_true(t->progress.loss < 0.08);
    free(f.bytes);
    ted4_trainer_finish(t);
}

static void test_values(void **state)
{
    static const char *const names[] = { "value of feature", "value of scaling", "value of offset",
                                         "value of phi", "value of tau" };
    ted4_trainer t;

    (void)state;
    for (int y = 0; y < TED4_TYPES; y++) {
        begin_at(&t, y == TED4_FEATURE   ? INTEGER_FROM + 5
                     : y == TED4_SCALING ? STAGE1 + 5
                                         : KEPT + 3);
        *ted4_anchor_value(&t.anchors, TED4_ROW_VALUE, 40 + (size_t)y, t.layout.first[y] + 1) =
            y % 2 ? NAN : -INFINITY;
        expect_back(&t, y < TED4_OFFSET ? STAGE1 : KEPT, "not finite", names[y], 40 + y);
        finish(&t);
    }
    begin_at(&t, 90);
    *ted4_anchor_value(&t.anchors, TED4_ROW_VALUE, 3, t.layout.temporal_logit) = NAN;
    expect_back(&t, 0, "not finite", "value of masks", 3);
    ball_train(&t, 299);
    *ted4_anchor_value(&t.anchors, TED4_ROW_POSITION, 64, 1) = NAN;
    ball_train(&t, 300);
    expect_back(&t, KEPT, "not finite", "value of position", 64);
    assert_true(t.monitor.state.factor == 0.25);
    finish(&t);
}

/* Changes a gradient after a step, and lets the monitor check it again. */
static int look_again(ted4_trainer *t, size_t visible, int channel, size_t lane, float gradient)
{
    float rate[256] = { 0 };

    ted4_schedule_rates(t, rate);
    t->visible_blocks.gradient[visible][(size_t)channel * TED4_LANES + lane] = gradient;
    ted4_gradients_block(&t->layout, rate, t->visible_blocks.raw[visible],
                         t->visible_blocks.gradient[visible],
                         t->visible_blocks.squares + visible * (TED4_BLOCK_TERMS + 1));
    return ted4_monitor_look(t, t->progress.last_loss, NULL, NULL);
}

static void expect_found(ted4_trainer *t, const char *cause, const char *term, size_t anchor)
{
    assert_true(t->monitor.found);
    assert_int_equal(t->monitor.anomaly.anchor, (int64_t)anchor);
    assert_string_equal(t->monitor.anomaly.cause, cause);
    assert_string_equal(t->monitor.anomaly.term, term);
}

static void test_gradients(void **state)
{
    ted4_trainer t;

    (void)state;
    for (int stage2 = 0; stage2 < 2; stage2++) {
        begin_at(&t, stage2 ? STAGE1 + 110 : KEPT + 20);

        const int offset = t.layout.first[TED4_OFFSET] + 5, phi = t.layout.first[TED4_PHI];
        const size_t anchor = t.visible_blocks.block[2] * (size_t)TED4_LANES + 7,
                     first = t.visible_blocks.block[0] * (size_t)TED4_LANES;
        const float usual = (float)ted4_scale_usual(&t.monitor.state.gradient[TED4_OFFSET]);

        assert_int_equal(look_again(&t, 2, offset, 7, 100 * usual), 0);
        assert_true(t.monitor.state.gradient[TED4_OFFSET].peak > 90);
        assert_true(t.monitor.state.gradient[TED4_OFFSET].peak < 120);
        assert_int_equal(look_again(&t, 2, offset, 7, -2e5f * usual), -1);
        expect_found(&t, "exploded", "gradient of offset", anchor);
        assert_int_equal(look_again(&t, 2, offset, 7, 1e30f), -1);
        expect_found(&t, "exploded", "gradient of offset", anchor);
        assert_int_equal(look_again(&t, 0, phi, 0, -INFINITY), -1);
        expect_found(&t, "exploded", "gradient of offset", anchor);
        assert_int_equal(look_again(&t, 2, offset, 7, 0), -1);
        expect_found(&t, "not finite", "gradient of phi", first);
        assert_int_equal(ted4_monitor_recover(&t), 0);
        assert_int_equal(t.iteration, stage2 ? STAGE1 : KEPT);
        finish(&t);
    }
}

/* The gradient of the bank's smoothness term follows the bank's values. */
static void test_networks(void **state)
{
    ted4_trainer t;

    (void)state;
    begin_at(&t, KEPT + 20);
    t.net.value[t.layout.bank + 2] = 1e12f;
    assert_int_equal(ted4_trainer_step(&t), 0);
    assert_string_equal(t.monitor.anomaly.cause, "exploded");
    assert_int_equal(t.iteration, KEPT);
    for (int which = 0; which < 2; which++) {
        ball_train(&t, KEPT + 20);
        t.net.value[which ? t.layout.bank + 2
                          : t.layout.netr + t.layout.shape.netr[TED4_NET_COLOUR].first] = NAN;
        expect_back(&t, KEPT, "not finite", which ? "weight of bank" : "weight of heads", -1);
    }
    finish(&t);
}

/* ---- collapse and divergence ---- */

/* Trains until the monitor goes back. Returns the number of steps. */
static int steps_until_back(ted4_trainer *t)
{
    for (int i = 0; i < 60; i++) {
        if (ted4_trainer_step(t) != 0)
            fail_msg("%s", t->message.text);
        if (t->monitor.state.rollbacks > 0)
            return i + 1;
    }
    return 0;
}

/* Everything disappears for a single cause: the opacity of all offsets, spans that have ended, or
 * extents of 2^-60. In the other two cases spans are set to the whole duration: the trained ones
 * may hide half of what is in view, and would be named as the cause. */
static void test_collapse(void **state)
{
    static const char *const names[] = { "opacity", "activation", "scale" };
    static const float always[4] = { 0, 0, 1, 0 };

    (void)state;
    for (int which = 0; which < 3; which++) {
        ted4_trainer t;

        begin_at(&t, KEPT + 35);
        for (size_t i = 0; i < t.anchors.n; i++) {
            const int tau = t.layout.first[TED4_TAU], scaling = t.layout.first[TED4_SCALING];

            for (int c = 0; c < 4; c++)
                *ted4_anchor_value(&t.anchors, TED4_ROW_VALUE, i, tau + c) = which == 1 ? -9.0f
                                                                                        : always[c];
            for (int c = 0; c < 6 && which == 2; c++)
                *ted4_anchor_value(&t.anchors, TED4_ROW_VALUE, i, scaling + c) = -60.0f;
        }
        if (which == 0)
            ball_set_biases(&t, TED4_NET_OPACITY, t.layout.head.n_offsets, -1000.0f);

        const int steps = steps_until_back(&t);

        if (steps != 32 || strcmp(t.monitor.anomaly.term, names[which]) != 0)
            fail_msg("%d steps: %s", steps, t.message.text);
        assert_string_equal(t.monitor.anomaly.cause, "collapsed");
        assert_true(t.monitor.anomaly.anchor >= 0);
        assert_int_equal(t.iteration, KEPT);
        assert_true(ted4_monitor_calm(&t));
        finish(&t);
    }
}

/* The picture turns white. */
static void test_divergence(void **state)
{
    ted4_trainer t;

    (void)state;
    begin_at(&t, STAGE1 - 40);
    ball_set_biases(&t, TED4_NET_COLOUR, 3u * t.layout.head.n_offsets, 1000.0f);
    assert_int_equal(ted4_trainer_step(&t), 0);
    assert_false(ted4_monitor_calm(&t));
    assert_int_equal(steps_until_back(&t), 31);
    assert_string_equal(t.monitor.anomaly.cause, "diverged");
    assert_string_equal(t.monitor.anomaly.term, "loss");
    assert_int_equal(t.iteration, KEPT);
    finish(&t);
}

/* If the screen is suddenly nearly empty but pictures do not get worse, there is no failure: after
 * a while this becomes the usual number of visible Gaussians. */
static void test_empty_space(void **state)
{
    ted4_trainer t;

    (void)state;
    begin_at(&t, KEPT + 21); /* well after the last growth, which costs quality for a while */
    t.monitor.state.screen.level += 6; /* as if 64 times as many had been usual */
    ball_train(&t, KEPT + 52);
    assert_int_equal(t.monitor.state.bad_screen, 31);
    assert_true(!ted4_monitor_calm(&t));
    ball_train(&t, KEPT + 54);
    assert_int_equal(t.monitor.state.rollbacks, 0);
    assert_true(ted4_monitor_calm(&t));
    assert_true(t.monitor.state.screen.n < 32);
    finish(&t);
}

/* ---- what follows ---- */

/* All learning rates become smaller. */
static void test_smaller(void **state)
{
    ted4_trainer t;
    float before[256] = { 0 }, after[256] = { 0 };

    (void)state;
    begin_at(&t, KEPT);
    ted4_schedule_rates(&t, before);
    ball_train(&t, KEPT + 1);

    const float weight = t.net.value[t.layout.netr];

    ted4_trainer_finish(&t);
    begin_at(&t, KEPT + 30);
    t.net.value[t.layout.netr] = NAN;
    expect_back(&t, KEPT, "not finite", "weight of motion", -1);
    ted4_schedule_rates(&t, after);
    for (int c = 0; c < t.layout.n_channels; c++)
        assert_true(after[c] == 0.5f * before[c]);

    const float start = t.net.value[t.layout.netr];

    ball_train(&t, KEPT + 1);
    assert_true(weight != start);
    assert_true(fabsf((t.net.value[t.layout.netr] - start) / (weight - start) - 0.5f) < 0.01f);
    ted4_trainer_finish(&t);
}

/* Going back to a state from before compression changed the layout. */
static void test_other_layout(void **state)
{
    ted4_train_options o = ball_options();
    ted4_trainer t;

    (void)state;
    ball_set(&o, "linear_scale=1");
    ball_begin(&t, &o, &still, NULL);
    ball_train(&t, STAGE1 - 1);
    for (size_t i = 0; i < t.anchors.n; i++)
        *ted4_anchor_value(&t.anchors, TED4_ROW_VALUE, i, t.layout.temporal_logit) = -10.0f;
    ball_train(&t, STAGE1 + 5);
    assert_int_equal(t.layout.head.motion, TED4_MOTION_NONE);
    t.net.value[t.layout.netr] = NAN;
    expect_back(&t, STAGE1, "not finite", "weight of heads", -1);
    assert_int_equal(t.layout.head.motion, TED4_MOTION_BANK);
    assert_true(!t.phase.stage2);
    finish(&t);
}

/* After going back three times, training ends with an error; the checkpoint still leads to the same
 * result. */
static void test_three_times(void **state)
{
    const ted4_train_options o = ball_options();
    ted4_trainer t;
    ball_file whole, again;
    char path[512];

    (void)state;
    snprintf(path, sizeof path, "%s", tiny_path(&folder, "checkpoint"));
    begin_at(&t, KEPT + 10);
    assert_int_equal(ted4_checkpoint_save(&t, path), 0);
    whole = ball_finish(&t);
    ted4_trainer_finish(&t);

    begin_at(&t, KEPT + 10);
    for (int i = 0; i < TED4_ROLLBACKS; i++) {
        ball_train(&t, KEPT + 10 + (uint64_t)i);
        *ted4_anchor_value(&t.anchors, TED4_ROW_VALUE, 9, 0) = NAN;
        assert_int_equal(ted4_checkpoint_save(&t, path), -1);
        expect_back(&t, KEPT, "not finite", "value of feature", 9);
    }
    ball_train(&t, KEPT + 5);
    *ted4_anchor_value(&t.anchors, TED4_ROW_VALUE, 9, 0) = NAN;
    assert_int_equal(ted4_trainer_step(&t), -1);
    assert_true(t.monitor.found);
    assert_int_equal(t.iteration, KEPT + 5);
    assert_non_null(strstr(t.message.text, "value of feature of anchor 9 is not finite at step "
                                           "255; learning rates were made smaller 3 times"));
    ted4_trainer_finish(&t);

    ball_begin(&t, &o, &scene, NULL);
    assert_int_equal(ted4_checkpoint_load(&t, path), 0);
    again = ball_finish(&t);
    ted4_trainer_finish(&t);
    ball_check_same(&whole, &again);
    free(whole.bytes);
    free(again.bytes);
}

/* Trains from step 320 to the end, with a failure at step 340 that goes back beyond step 320. */
static ball_file fail_again(ted4_trainer *t)
{
    ball_train(t, 340);
    t->net.value[t->layout.bank] = NAN;
    expect_back(t, KEPT, "not finite", "weight of bank", -1);
    assert_true(t->monitor.state.factor == 0.25);
    return ball_finish(t);
}

/* A checkpoint contains the state to which a later failure goes back. */
static void test_resumed(void **state)
{
    const ted4_train_options o = ball_options();
    ted4_trainer t;
    ball_file whole, again, calm;
    char path[512];

    (void)state;
    snprintf(path, sizeof path, "%s", tiny_path(&folder, "checkpoint"));
    begin_at(&t, 0);
    calm = ball_finish(&t);
    ted4_trainer_finish(&t);
    begin_at(&t, 300);
    t.net.value[t.layout.bank] = NAN;
    expect_back(&t, KEPT, "not finite", "weight of bank", -1);
    ball_train(&t, 320);
    assert_int_equal(ted4_checkpoint_save(&t, path), 0);
    whole = fail_again(&t);
    ted4_trainer_finish(&t);

    ball_begin(&t, &o, &scene, NULL);
    if (ted4_checkpoint_load(&t, path) != 0)
        fail_msg("%s", t.message.text);
    assert_int_equal(t.iteration, 320);
    assert_int_equal(t.monitor.state.rollbacks, 1);
    assert_non_null(t.monitor.good.bytes);
    again = fail_again(&t);
    ted4_trainer_finish(&t);
    ball_check_same(&whole, &again);
    assert_true(calm.size != whole.size || memcmp(calm.bytes, whole.bytes, calm.size) != 0);
    free(calm.bytes);
    free(whole.bytes);
    free(again.bytes);
}

/* Keeps a state, fails after some more steps, and asserts that training continues with the pictures
 * that come next in that state or, if there were no steps, with those after them. */
static void check_skipped(int batch, uint64_t step, uint64_t more)
{
    ted4_train_options o = ball_options();
    ted4_snapshot before = { 0 };
    const uint32_t *item;
    ted4_trainer t;
    ted4_order want;
    uint32_t drawn[64];
    size_t n;

    o.view = TED4_VIEW_COLOUR;
    o.batch = batch;
    ball_begin(&t, &o, &scene, NULL);
    ball_train(&t, step);
    assert_int_equal(ted4_state_take(&t, &before), 0);
    if (more == 0)
        assert_int_equal(ted4_next_pictures(&t, &item, &n), 0);
    want = t.order;
    assert_in_range(want.n, 1, sizeof drawn / sizeof *drawn);
    memcpy(drawn, want.item, want.n * sizeof *drawn);
    assert_int_equal(ted4_state_restore(&t, &before), 0);
    ted4_snapshot_free(&t.monitor.good);
    t.monitor.good = before;
    ball_train(&t, step + more);
    t.net.value[t.layout.bank] = NAN;
    assert_int_equal(ted4_trainer_step(&t), 0);
    assert_int_equal(t.monitor.state.rollbacks, 1);
    assert_int_equal(t.iteration, step);
    assert_int_equal(t.order.round, want.round);
    assert_int_equal(t.order.next, want.next);
    assert_memory_equal(t.order.item, drawn, want.n * sizeof *drawn);
    ted4_trainer_finish(&t);
}

/* If the step after the good state fails, the same pictures would fail again: they are skipped,
 * within a round, at its end, and at the beginning of training. If a later step fails, smaller
 * steps lead there another way, and no picture is skipped. */
static void test_skipped(void **state)
{
    const uint32_t n = (uint32_t)scene.n_pictures;

    (void)state;
    check_skipped(1, 0, 0);
    check_skipped(1, 3, 0);
    check_skipped(1, n, 0);
    check_skipped(1, 3, 1);
    check_skipped(2, 0, 0);
    check_skipped(2, 3, 0);
    check_skipped(2, n / 2, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_scale),       cmocka_unit_test(test_healthy),
        cmocka_unit_test(test_values),      cmocka_unit_test(test_gradients),
        cmocka_unit_test(test_networks),    cmocka_unit_test(test_collapse),
        cmocka_unit_test(test_divergence),  cmocka_unit_test(test_empty_space),
        cmocka_unit_test(test_smaller),     cmocka_unit_test(test_other_layout),
        cmocka_unit_test(test_three_times), cmocka_unit_test(test_resumed),
        cmocka_unit_test(test_skipped),
    };

    return cmocka_run_group_tests_name("monitor", tests, set_up, tear_down);
}
