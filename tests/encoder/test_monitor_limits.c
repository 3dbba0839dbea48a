/* test_monitor_limits.c - the limits of train/monitor/monitor.c, from both sides: the monitor is
 * given losses, norms of gradients and numbers of Gaussians just below and just above each limit,
 * without any training. Whole trainings that fail: test_monitor.c.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <string.h>

#include "cloud_case.h"
#include "test.h"
#include "train/monitor/monitor.h"

/* Numbers that make up a usual size, and steps in a row that make a failure. */
enum { USUAL_STEPS = 100, ROW = 32 };

#define USUAL_LOSS  0.08
#define USUAL_DRAWN 799.0 /* the monitor counts one more: 800 */

static cloud_case cloud;
static ted4_trainer trainer;
static ted4_monitor_state usual;

/* Lets the monitor look at a step of which nothing is visible, with this norm of the gradient of
 * the colours, loss and number of Gaussians. Returns what the monitor returns. */
static int look(double norm, double loss, double drawn)
{
    static const ted4_generate_input nothing_in_view;

    trainer.monitor.norm[TED4_TERM_COLOUR] = norm;
    trainer.monitor.drawn = drawn;
    return ted4_monitor_look(&trainer, loss, &nothing_in_view, NULL);
}

static int set_up(void **state)
{
    (void)state;
    cloud_make(&cloud, 5);
    cloud_begin(&cloud, &trainer);
    trainer.visible_blocks.n = 0;
    memset(trainer.net.gradient, 0, trainer.layout.n_net * sizeof *trainer.net.gradient);
    for (int i = 0; i < USUAL_STEPS; i++)
        assert_int_equal(look(1, USUAL_LOSS, USUAL_DRAWN), 0);
    usual = trainer.monitor.state;
    return 0;
}

static int tear_down(void **state)
{
    (void)state;
    ted4_trainer_finish(&trainer);
    return 0;
}

static void begin(void)
{
    trainer.monitor.state = usual;
    trainer.monitor.found = 0;
    trainer.monitor.anomaly = (ted4_anomaly) { .cause = NULL };
}

static void expect_cause(const char *cause)
{
    assert_true(trainer.monitor.found);
    assert_string_equal(trainer.monitor.anomaly.cause, cause);
}

static void test_exploded(void **state)
{
    (void)state;
    begin();
    assert_int_equal(look(0.999e5, USUAL_LOSS, USUAL_DRAWN), 0);
    begin();
    assert_int_equal(look(1.001e5, USUAL_LOSS, USUAL_DRAWN), -1);
    expect_cause("exploded");
    assert_string_equal(trainer.monitor.anomaly.term, "gradient of colour");
}

/* Nothing is judged before the usual size is known. */
static void test_unknown(void **state)
{
    (void)state;
    begin();
    memset(&trainer.monitor.state, 0, sizeof trainer.monitor.state);
    for (int i = 0; i < USUAL_STEPS - 1; i++)
        assert_int_equal(look(1, USUAL_LOSS, USUAL_DRAWN), 0);
    assert_int_equal(look(1e9, 1e9, 0), 0);
    assert_true(ted4_monitor_calm(&trainer));
    assert_int_equal(look(1e9, USUAL_LOSS, USUAL_DRAWN), -1);
    expect_cause("exploded");
}

/* One step is suspicious: times the usual loss, and at least a certain loss. */
static void test_high_loss(void **state)
{
    (void)state;
    begin();
    assert_int_equal(look(1, 2.99 * USUAL_LOSS, USUAL_DRAWN), 0);
    assert_true(ted4_monitor_calm(&trainer));
    begin();
    assert_int_equal(look(1, 3.01 * USUAL_LOSS, USUAL_DRAWN), 0);
    assert_false(ted4_monitor_calm(&trainer));
    assert_int_equal(look(1, USUAL_LOSS, USUAL_DRAWN), 0);
    assert_true(ted4_monitor_calm(&trainer));

    begin();
    trainer.monitor.state.loss.level -= 5; /* as if a 32nd of it had been usual */
    assert_int_equal(look(1, 0.0999, USUAL_DRAWN), 0);
    assert_true(ted4_monitor_calm(&trainer));
    assert_int_equal(look(1, 0.1001, USUAL_DRAWN), 0);
    assert_false(ted4_monitor_calm(&trainer));
}

/* The usual size follows by 2^0.05 per step at most, so that ten times the usual loss stays above
 * three times the usual one for the whole row. */
static void test_diverged(void **state)
{
    (void)state;
    begin();
    for (int i = 1; i < ROW; i++)
        assert_int_equal(look(1, 10 * USUAL_LOSS, USUAL_DRAWN), 0);
    assert_int_equal(look(1, 10 * USUAL_LOSS, USUAL_DRAWN), -1);
    expect_cause("diverged");
}

static void test_nearly_empty(void **state)
{
    (void)state;
    begin();
    assert_int_equal(look(1, USUAL_LOSS, 101 - 1), 0);
    assert_true(ted4_monitor_calm(&trainer));
    begin();
    assert_int_equal(look(1, USUAL_LOSS, 99 - 1), 0);
    assert_false(ted4_monitor_calm(&trainer));
    assert_int_equal(look(1, USUAL_LOSS, 101 - 1), 0);
    assert_true(ted4_monitor_calm(&trainer));
}

/* A nearly empty screen for the whole row; the losses alternate. Returns what the monitor returns
 * at its end. */
static int empty_row(double loss, double other)
{
    begin();
    for (int i = 1; i < ROW; i++) {
        assert_int_equal(look(1, i % 2 ? loss : other, 5), 0);
        assert_int_equal(trainer.monitor.state.bad_screen, i);
    }
    return look(1, other, 5);
}

/* The mean loss of the row decides. If the pictures are no worse, what is on screen becomes usual,
 * and the monitor begins to measure it anew. */
static void test_collapsed(void **state)
{
    (void)state;
    assert_int_equal(empty_row(USUAL_LOSS, 1.49 * USUAL_LOSS), 0);
    assert_true(ted4_monitor_calm(&trainer));
    assert_int_equal(trainer.monitor.state.screen.n, 0);
    assert_int_equal(empty_row(USUAL_LOSS, 1.51 * USUAL_LOSS), -1);
    expect_cause("collapsed");
}

/* All usual sizes begin anew in each phase. */
static void test_phases(void **state)
{
    int *const phases[] = { &trainer.phase.stage2, &trainer.phase.integer,
                            &trainer.phase.clock_stopped };

    (void)state;
    for (size_t i = 0; i < sizeof phases / sizeof phases[0]; i++) {
        begin();
        *phases[i] = 1;
        assert_int_equal(look(1e9, 1e9, 0), 0);
        assert_true(ted4_monitor_calm(&trainer));
        assert_int_equal(trainer.monitor.state.gradient[TED4_TERM_COLOUR].n, 1);
        assert_int_equal(trainer.monitor.state.loss.n, 1);
        assert_int_equal(trainer.monitor.state.screen.n, 1);
        *phases[i] = 0;
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_exploded),     cmocka_unit_test(test_unknown),
        cmocka_unit_test(test_high_loss),    cmocka_unit_test(test_diverged),
        cmocka_unit_test(test_nearly_empty), cmocka_unit_test(test_collapsed),
        cmocka_unit_test(test_phases),
    };

    return cmocka_run_group_tests(tests, set_up, tear_down);
}
