/* test_checkpoint_fields.c - train/monitor/checkpoint.c holds every number that a run needs when it
 * is resumed, those that only the program reports too: each is set to a value of its own by hand,
 * saved, and compared in a fresh trainer. States that no training reaches are refused. Resumed
 * trainings: test_trainer.c.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <stdlib.h>
#include <string.h>

#include "ball_group.h"
#include "test.h"
#include "tool/search_report.h"
#include "train/monitor/checkpoint.h"
#include "train/model/header_from_options.h"
#include "train/step/stages.h"

enum { TRIALS = 2 };

static ted4_train_options options;

static int set_up_all(void **state)
{
    options = ball_options();
    ball_set(&options, "capacity=1");
    return set_up(state);
}

/* The next of a sequence of numbers in (0, 1), of which no two are equal. */
static double fresh_number(void)
{
    static unsigned calls;

    return (double)++calls / 0x1p22;
}

static void fill_floats(float *x, size_t n)
{
    for (size_t i = 0; i < n; i++)
        x[i] = (float)fresh_number();
}

static void fill_scale(ted4_scale *s)
{
    *s = (ted4_scale) { fresh_number(), fresh_number(), (uint64_t)(1e6 * fresh_number()) };
}

static void fill_monitor(ted4_monitor_state *w)
{
    w->factor = 0.25;
    w->rollbacks = 2;
    w->phase = 5;
    w->bad_loss = 6;
    w->bad_screen = 7;
    w->usual_loss = fresh_number();
    w->lost = fresh_number();
    for (int k = 0; k < TED4_TERMS; k++)
        fill_scale(&w->gradient[k]);
    fill_scale(&w->loss);
    fill_scale(&w->screen);
}

static void fill_progress(ted4_progress *p)
{
    p->loss = fresh_number();
    p->l1 = fresh_number();
    p->ssim = fresh_number();
    p->last_loss = fresh_number();
    for (int y = 0; y < TED4_TYPES; y++)
        p->bits[y] = fresh_number();
    p->splats = fresh_number();
    p->splat_pixels = fresh_number();
}

static void fill_parameters(ted4_trainer *t)
{
    for (int r = TED4_ROW_VALUE; r < TED4_ROWS; r++)
        fill_floats(t->anchors.data[r],
                    t->anchors.n_blocks * (size_t)t->anchors.rows[r] * TED4_LANES);
    fill_floats(t->net.value, t->layout.n_net);
    fill_floats(t->net.m, t->layout.n_net);
    fill_floats(t->net.v, t->layout.n_net);
    for (uint32_t i = 0; i < t->colour.n_cameras; i++) {
        t->colour.steps[i] = 3 + i;
        fill_floats(t->colour.value[i], TED4_COLOUR_VALUES);
        fill_floats(t->colour.m[i], TED4_COLOUR_VALUES);
        fill_floats(t->colour.v[i], TED4_COLOUR_VALUES);
    }
    for (size_t i = 0; i < t->poses.n; i++) {
        t->poses.steps[i] = 5 + i;
        fill_floats(t->poses.value[i], TED4_POSE_VALUES);
        fill_floats(t->poses.m[i], TED4_POSE_VALUES);
        fill_floats(t->poses.v[i], TED4_POSE_VALUES);
    }
    t->poses.decision = TED4_POSES_REFINED;
    t->poses.moved = fresh_number();
}

/* A trainer within stage 1, with numbers everywhere. */
static void begin(ted4_trainer *t)
{
    ball_begin(t, &options, &balls, NULL);
    assert_int_equal(ted4_state_take(t, &t->monitor.good), 0);
    t->monitor.good_at = 11;
    fill_parameters(t);
    fill_monitor(&t->monitor.state);
    fill_progress(&t->progress);
    t->voxel = 1.5;
    t->iteration = 13;
    t->seconds = 12.5;
    t->search.probed = 1;
    t->search.probe_loss[0] = fresh_number();
    t->search.probe_loss[1] = fresh_number();
    t->closing = (ted4_closing) { 31, 21, 11 };
    t->order.next = 2;
    t->order.round = 9;
    t->order.item[0] ^= t->order.item[1];
    t->order.item[1] ^= t->order.item[0];
    t->order.item[0] ^= t->order.item[1];
}

/* Moves it into the integer stage, with results of the model search. */
static void enter_integer_stage(ted4_trainer *t)
{
    t->phase.stage2 = t->phase.integer = 1;
    t->phase.stage2_start = 10;
    t->phase.rate_norm_header = t->layout.head;
    t->net.shift = malloc(t->layout.shape.n_units + 1);
    assert_non_null(t->net.shift);
    for (size_t i = 0; i < t->layout.shape.n_units; i++)
        t->net.shift[i] = (uint8_t)(i % 16);
    t->search.decided = TED4_DECIDED_BITS;
    for (int i = 0; i < TED4_WEIGHT_GRIDS; i++)
        t->net.bits[i] = 3 + i;
    t->search.trial = calloc(TRIALS, sizeof *t->search.trial);
    assert_non_null(t->search.trial);
    t->search.n_trials = TRIALS;
    for (int i = 0; i < TRIALS; i++)
        t->search.trial[i] =
            (struct ted4_trial) { .candidate = i,
                                  .from = 20 + i,
                                  .to = 10 + i,
                                  .steps = 30 * i,
                                  .taken = i,
                                  .before = { fresh_number(), fresh_number(), fresh_number() },
                                  .after = { fresh_number(), fresh_number(), fresh_number() } };
}

static void check_floats(const float *a, const float *b, size_t n)
{
    assert_memory_equal(a, b, n * sizeof *a);
}

static void check_parameters(const ted4_trainer *a, const ted4_trainer *b)
{
    const size_t n_net = a->phase.stage2 ? a->layout.n_net : a->layout.nete;

    assert_int_equal(a->anchors.n, b->anchors.n);
    for (int r = 0; r < TED4_ROWS; r++)
        check_floats(a->anchors.data[r], b->anchors.data[r],
                     a->anchors.n_blocks * (size_t)a->anchors.rows[r] * TED4_LANES);
    check_floats(a->net.value, b->net.value, n_net);
    check_floats(a->net.m, b->net.m, n_net);
    check_floats(a->net.v, b->net.v, n_net);
    assert_true(a->colour.n_cameras > 0);
    assert_int_equal(a->colour.n_cameras, b->colour.n_cameras);
    for (uint32_t i = 0; i < a->colour.n_cameras; i++) {
        assert_int_equal(a->colour.steps[i], b->colour.steps[i]);
        check_floats(a->colour.value[i], b->colour.value[i], TED4_COLOUR_VALUES);
        check_floats(a->colour.m[i], b->colour.m[i], TED4_COLOUR_VALUES);
        check_floats(a->colour.v[i], b->colour.v[i], TED4_COLOUR_VALUES);
    }
}

static void check_poses(const ted4_poses *a, const ted4_poses *b)
{
    assert_true(a->n > 0);
    assert_int_equal(a->n, b->n);
    assert_int_equal(a->decision, b->decision);
    assert_true(a->moved == b->moved);
    for (size_t i = 0; i < a->n; i++) {
        assert_int_equal(a->steps[i], b->steps[i]);
        check_floats(a->value[i], b->value[i], TED4_POSE_VALUES);
        check_floats(a->m[i], b->m[i], TED4_POSE_VALUES);
        check_floats(a->v[i], b->v[i], TED4_POSE_VALUES);
    }
}

static void check_search(const ted4_trainer *a, const ted4_trainer *b)
{
    assert_int_equal(a->search.probed, b->search.probed);
    assert_memory_equal(a->search.probe_loss, b->search.probe_loss, sizeof a->search.probe_loss);
    assert_memory_equal(&a->closing, &b->closing, sizeof a->closing);
    assert_int_equal(a->search.decided, b->search.decided);
    assert_int_equal(a->search.n_trials, b->search.n_trials);
    for (size_t i = 0; i < a->search.n_trials; i++)
        assert_memory_equal(&a->search.trial[i], &b->search.trial[i], sizeof a->search.trial[i]);
    assert_memory_equal(a->net.bits, b->net.bits, sizeof a->net.bits);
    assert_int_equal((a->net.shift != NULL), (b->net.shift != NULL));
    if (a->net.shift != NULL)
        assert_memory_equal(a->net.shift, b->net.shift, a->layout.shape.n_units);
}

/* good: with the monitor's last good state. */
static void check_same(const ted4_trainer *a, const ted4_trainer *b, int good)
{
    assert_true(a->voxel == b->voxel);
    assert_int_equal(a->iteration, b->iteration);
    assert_true(a->seconds == b->seconds);
    assert_int_equal(a->phase.stage2, b->phase.stage2);
    assert_int_equal(a->phase.integer, b->phase.integer);
    assert_int_equal(a->phase.stage2_start, b->phase.stage2_start);
    assert_true(ted4_header_same(&a->phase.rate_norm_header, &b->phase.rate_norm_header));
    assert_memory_equal(&a->progress, &b->progress, sizeof a->progress);
    assert_memory_equal(&a->monitor.state, &b->monitor.state, sizeof a->monitor.state);
    assert_int_equal(a->order.n, b->order.n);
    assert_memory_equal(a->order.item, b->order.item, a->order.n * sizeof *a->order.item);
    assert_int_equal(a->order.next, b->order.next);
    assert_int_equal(a->order.round, b->order.round);
    check_search(a, b);
    check_parameters(a, b);
    check_poses(&a->poses, &b->poses);
    if (!good)
        return;
    assert_int_equal(a->monitor.good_at, b->monitor.good_at);
    assert_int_equal(a->monitor.good.size, b->monitor.good.size);
    assert_memory_equal(a->monitor.good.bytes, b->monitor.good.bytes, a->monitor.good.size);
}

/* What `ted4info --why` says of a file is what it would have said without the interruption. */
static void check_report(const ted4_trainer *a, const ted4_trainer *b)
{
    char *said = ted4_search_report(a), *again = ted4_search_report(b);

    assert_non_null(said);
    assert_non_null(again);
    assert_non_null(strstr(said, "capacity.time=needed: loss 0."));
    assert_string_equal(said, again);
    free(said);
    free(again);
}

static void check_file(ted4_trainer *t)
{
    ted4_trainer again;
    char path[512];

    snprintf(path, sizeof path, "%s", tiny_path(&folder, "checkpoint"));
    if (ted4_checkpoint_save(t, path) != 0)
        fail_msg("%s", t->message.text);
    ball_begin(&again, &options, &balls, NULL);
    if (ted4_checkpoint_load(&again, path) != 0)
        fail_msg("%s", again.message.text);
    check_same(t, &again, 1);
    check_report(t, &again);
    ted4_trainer_finish(&again);
}

/* A snapshot of the state alone: the one to which the monitor goes back. */
static void check_state(ted4_trainer *t)
{
    ted4_snapshot s = { 0 };
    ted4_trainer again;

    assert_int_equal(ted4_state_take(t, &s), 0);
    ball_begin(&again, &options, &balls, NULL);
    if (ted4_state_restore(&again, &s) != 0)
        fail_msg("%s", again.message.text);
    check_same(t, &again, 0);
    check_report(t, &again);
    ted4_trainer_finish(&again);
    ted4_snapshot_free(&s);
}

static void test_fields(void **state)
{
    (void)state;
    for (int integer = 0; integer < 2; integer++) {
        ted4_trainer t;

        begin(&t);
        if (integer)
            enter_integer_stage(&t);
        check_file(&t);
        check_state(&t);
        ted4_trainer_finish(&t);
    }
}

/* ---- what a state cannot be ---- */

static void put_held_out(ted4_trainer *t)
{
    t->order.item[0] = 3;
}

static void put_twice(ted4_trainer *t)
{
    t->order.item[0] = t->order.item[1];
}

static void put_beyond(ted4_trainer *t)
{
    t->order.item[0] = (uint32_t)balls.n_pictures;
}

static void end_order(ted4_trainer *t)
{
    t->order.next = t->order.n + 1;
}

static void leave_cube_above(ted4_trainer *t)
{
    *ted4_anchor_value(&t->anchors, TED4_ROW_POSITION, 5, 1) = 1.5f;
}

static void leave_cube_below(ted4_trainer *t)
{
    *ted4_anchor_value(&t->anchors, TED4_ROW_POSITION, 5, 1) = -1.5f;
}

static void train_too_long(ted4_trainer *t)
{
    t->iteration = ted4_trainer_total(t) + 1;
}

static void have_no_rate(ted4_trainer *t)
{
    t->monitor.state.factor = 0;
}

static void go_back_too_often(ted4_trainer *t)
{
    t->monitor.state.rollbacks = 4;
}

static void have_no_voxel(ted4_trainer *t)
{
    t->voxel = 0;
}

static void decide_nothing(ted4_trainer *t)
{
    t->poses.decision = TED4_POSES_GIVEN + 1;
}

/* The hash of such a file is right, so that only the check of its contents can refuse it. Picture
 * 3 is held out. */
static void test_impossible(void **state)
{
    static void (*const spoil[])(
        ted4_trainer *) = { put_held_out,      put_twice,        put_beyond,     end_order,
                            leave_cube_above,  leave_cube_below, train_too_long, have_no_rate,
                            go_back_too_often, have_no_voxel,    decide_nothing };

    (void)state;
    balls.pictures[3].is_test = 1;
    for (size_t i = 0; i < sizeof spoil / sizeof spoil[0]; i++) {
        ted4_trainer t, again;
        ted4_snapshot s = { 0 };

        begin(&t);
        spoil[i](&t);
        assert_int_equal(ted4_state_take(&t, &s), 0);
        ball_begin(&again, &options, &balls, NULL);
        if (ted4_state_restore(&again, &s) == 0)
            fail_msg("impossible state %d was restored", (int)i);
        ted4_trainer_finish(&t);
        ted4_trainer_finish(&again);
        ted4_snapshot_free(&s);
    }
    balls.pictures[3].is_test = 0;
}

/* Takes a state, changes a bit of the scene, and asserts that the state is refused as that of
 * another balls. */
static void check_other_scene(void *number)
{
    uint8_t *const byte = number;
    ted4_trainer t;
    ted4_snapshot s = { 0 };

    ball_begin(&t, &options, &balls, NULL);
    assert_int_equal(ted4_state_take(&t, &s), 0);
    *byte ^= 1;
    assert_int_equal(ted4_state_restore(&t, &s), -1);
    assert_non_null(strstr(t.message.text, "other pictures, cameras, points or background"));
    *byte ^= 1;
    ted4_trainer_finish(&t);
    ted4_snapshot_free(&s);
}

static void test_other_scene(void **state)
{
    (void)state;
    check_other_scene(&balls.content);
    check_other_scene(&balls.pictures[7].camera.fx);
    check_other_scene(&balls.pictures[7].camera.t[1]);
    check_other_scene(&balls.points[40]);
    check_other_scene(&balls.point_rgb[40]);
    check_other_scene(&balls.background[2]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_fields),
        cmocka_unit_test(test_impossible),
        cmocka_unit_test(test_other_scene),
    };

    return cmocka_run_group_tests(tests, set_up_all, tear_down);
}
