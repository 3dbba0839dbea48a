/* test_estimate.c - the estimate of a training's duration, tested on recorded runs. Their logs have
 * one line for many steps; the steps between two lines are assumed to take equally long, apart from
 * the extra time of a probe, of trials and of multi-view seeding.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "test.h"
#include "estimate_runs.h"
#include "larger.h"
#include "tool/estimate.h"

/* Times in the schedule: the probe, multi-view seeding, and trials at these shares of a stage; and
 * the numbers of steps that the search and the last trial are expected to take. */
#define PROBE_AT   0.25
#define MV_SEED_AT 0.3
#define DECIDE_AT  0.15
#define INTEGER_AT 0.8
#define SEARCH     1120.0
#define LAST       250.0

/* Required accuracy: after a tenth of the run, the estimate is within a quarter of the remaining
 * time, or within this share of the whole. */
#define FROM  0.1
#define NEAR  0.25
#define CLOSE 0.02

typedef struct {
    const recorded_run *run;
    ted4_estimate e;
    ted4_work w;
    double clock, worst;
    int looks;
} replay;

static double whole(const recorded_run *r)
{
    return r->line[r->n - 1].seconds;
}

static void look(replay *p, double seconds)
{
    p->clock += seconds;
    ted4_estimate_see(&p->e, &p->w, p->clock);

    const double left = ted4_estimate_left(&p->e), truth = whole(p->run) - p->clock;

    if (p->clock < FROM * whole(p->run) || fabs(left - truth) < CLOSE * whole(p->run))
        return;
    p->looks++;
    p->worst = larger(p->worst, fabs(left / truth - 1.0));
    if (!(fabs(left / truth - 1.0) <= NEAR))
        fail_msg("%s: at step %.0f, %.1f s of %.1f: %.1f s left, said %.1f", p->run->name,
                 p->w.step, p->clock, whole(p->run), truth, left);
}

/* Simulates the extra work of one step: so many looks at the spent steps of a budget, whose work
 * takes so many seconds in all. */
static void long_step(replay *p, int probing, double budget, double spent, double seconds)
{
    const double begin = p->w.step;
    enum { LOOKS = 100 };

    p->w.probing = probing;
    p->w.budget = budget;
    for (int i = 1; i <= LOOKS; i++) {
        p->w.spent = spent * i / LOOKS;
        p->w.step = probing ? begin + fmod(p->w.spent, p->w.probe + 1) : begin;
        look(p, seconds / LOOKS);
    }
    p->w.step = probing ? begin + p->w.probe : begin;
    p->w.probing = 0;
    p->w.budget = p->w.spent = 0;
}

/* Returns whether step x lies between two lines: after from, at to at the latest. */
static int between(double x, double from, double to)
{
    return x > from && x <= to;
}

/* Makes the steps up to the next line, with everything due among them. pace: seconds per step so
 * far. Returns the new pace. */
static double go(replay *p, const run_line *to, double pace)
{
    const recorded_run *r = p->run;
    const double from = p->w.step, seconds = to->seconds - p->clock, n = to->step - from;
    const double probe_at = PROBE_AT * r->stage1, decide_at = r->stage1 + DECIDE_AT * r->stage2,
                 integer_at = r->stage1 + INTEGER_AT * r->stage2;
    const int probes = r->probe > 0 && between(probe_at + r->probe, from, to->step),
              is_mv_seed = between(MV_SEED_AT * r->stage1 + 1, from, to->step);
    const int decides = between(decide_at + 1, from, to->step),
              prunes = between(integer_at + 1, from, to->step);
    const double extra = probes ? fmin((n + r->probe) * pace, seconds) : n * pace,
                 more = fmax(seconds - extra, 0.0);

    if (probes) {
        long_step(p, 1, 2 * r->probe, 2 * r->probe, 2 * r->probe * pace);
        p->w.probe = 0;
    }
    if (decides || prunes) {
        p->w.trials = decides ? LAST : 0;
        long_step(p, 0, decides ? SEARCH : LAST, decides ? r->search : LAST, more);
    }

    /* The step with multi-view seeding takes the remaining time; from then on there are more
     * anchors. */
    const double left = to->seconds - p->clock, steps = to->step - p->w.step,
                 rest = is_mv_seed ? fmax(left - steps * pace, 0.0) : 0.0;

    while (p->w.step < to->step) {
        const int here = is_mv_seed && p->w.step == MV_SEED_AT * r->stage1;

        p->w.anchors = !is_mv_seed || p->w.step >= MV_SEED_AT * r->stage1 ? to->anchors
                                                                          : p->w.anchors;
        p->w.step++;
        look(p, (left - rest) / steps + (here ? rest : 0.0));
    }
    return (left - rest) / steps;
}

static void test_runs(void **state)
{
    (void)state;
    for (size_t k = 0; k < sizeof runs / sizeof runs[0]; k++) {
        const recorded_run *r = &runs[k];
        replay p = { .run = r };
        double pace = r->line[0].seconds / r->line[0].step;

        ted4_estimate_begin(&p.e);
        p.w = (ted4_work) { .stage1 = r->stage1,
                            .stage2 = r->stage2,
                            .first_growth = 0.05,
                            .mv_seed_at = MV_SEED_AT,
                            .mv_seed_share = r->mv_seed_share,
                            .most_anchors = r->most_anchors,
                            .probe = r->probe,
                            .trials = SEARCH + LAST,
                            .anchors = r->line[0].anchors };
        for (int i = 0; i < r->n; i++)
            pace = go(&p, &r->line[i], pace);
        printf("%s: %d looks, at most %.0f %% off\n", r->name, p.looks, 100 * p.worst);
        assert_true(p.looks > 1000);
    }
}

static ted4_work plain(void)
{
    return (ted4_work) { .stage1 = 1000,
                         .stage2 = 0,
                         .first_growth = 0.05,
                         .mv_seed_at = 0.3,
                         .most_anchors = 100,
                         .anchors = 100 };
}

/* Before the first steps nothing is known, and before a hundred steps no estimate is given. */
static void test_beginning(void **state)
{
    ted4_estimate e;
    ted4_work w = plain();

    (void)state;
    ted4_estimate_begin(&e);
    assert_true(ted4_estimate_left(&e) < 0);
    assert_true(!ted4_estimate_ready(&e));
    for (int i = 0; i <= 100; i++) {
        w.step = i;
        ted4_estimate_see(&e, &w, 5 + 0.01 * i);
        assert_int_equal(ted4_estimate_ready(&e), i == 100);
    }
    assert_true(fabs(ted4_estimate_left(&e) - 9.0) < 0.2);
}

/* One slow step, a rollback or a pause does not change the pace. */
static void test_disturbed(void **state)
{
    ted4_estimate e;
    ted4_work w = plain();
    double clock = 0;

    (void)state;
    ted4_estimate_begin(&e);
    for (int i = 0; i <= 500; i++) {
        w.step = i;
        clock += 0.01 + (i == 450 ? 20.0 : 0.0);
        ted4_estimate_see(&e, &w, clock);
    }
    assert_true(ted4_estimate_left(&e) < 1.25 * 5.0);
    assert_true(ted4_estimate_left(&e) > 4.9);
    clock += 100;
    ted4_estimate_rewind(&e, clock);
    w.step = 400;
    clock += 0.01;
    ted4_estimate_see(&e, &w, clock);
    assert_true(fabs(ted4_estimate_left(&e) / 6.0 - 1.0) < 0.25);
}

int main(void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test(test_beginning),
                                        cmocka_unit_test(test_disturbed),
                                        cmocka_unit_test(test_runs) };

    return cmocka_run_group_tests_name("estimate of training time", tests, NULL, NULL);
}
