/* test_schedule.c - train/step/schedule.c: the learning rate of every kind of parameter at the
 * beginning, in the middle and at the end of both stages, against the recipe written down here
 * once more. A rate decays exponentially: in the middle of a stage it is the geometric mean of the
 * first and the last one.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <math.h>
#include <stdlib.h>

#include "cloud_case.h"
#include "test.h"
#include "train/model/weight_grid.h"
#include "train/step/schedule.h"

enum { STAGE1 = 12000, STAGE2 = 2000, FRAMES = 5, CHANNELS = 256 };

static cloud_case cloud;
static ted4_trainer trainer;

static int set_up(void **state)
{
    (void)state;
    cloud_make(&cloud, FRAMES);
    cloud.options.stage1 = STAGE1;
    cloud.options.stage2 = STAGE2;
    cloud.options.lr_feature = 0.011;
    cloud.options.lr_scaling = 0.012;
    cloud.options.lr_offset = 0.013;
    cloud.options.lr_phi = 0.014;
    cloud.options.lr_tau = 0.015;
    cloud.options.lr_mask = 0.016;
    cloud.options.lr_heads = 0.017;
    cloud.options.lr_motion = 0.018;
    cloud.options.lr_prior = 0.019;
    cloud_begin(&cloud, &trainer);
    assert_true(trainer.layout.n_channels <= CHANNELS);
    assert_int_equal(trainer.layout.head.scale_domain, TED4_SCALE_LOG2);
    return 0;
}

static int tear_down(void **state)
{
    (void)state;
    ted4_trainer_finish(&trainer);
    return 0;
}

/* A parameter's first and last rate in a stage. */
typedef struct {
    double first, last;
} course;

static double at(course c, double progress)
{
    return c.first == 0 ? 0 : c.first * pow(c.last / c.first, progress);
}

/* Brings the trainer to a place in a stage (1 or 2). */
static void go(int stage, double progress)
{
    trainer.phase.stage2 = stage == 2;
    trainer.phase.integer = 0;
    trainer.phase.stage2_start = stage == 2 ? STAGE1 : 0;
    trainer.iteration = stage == 2 ? STAGE1 + (uint64_t)(progress * STAGE2)
                                   : (uint64_t)(progress * STAGE1);
}

static void expect_rate(const char *what, double got, double want)
{
    if (!(fabs(got - want) <= 1e-5 * want))
        fail_msg("rate of %s at step %d: %.9g, expected %.9g", what, (int)trainer.iteration, got,
                 want);
}

static void expect_channels(const char *what, int first, int n, course c, double progress)
{
    float rate[CHANNELS] = { 0 };

    ted4_schedule_rates(&trainer, rate);
    assert_true(first >= 0);
    for (int i = first; i < first + n; i++)
        expect_rate(what, (double)rate[i], at(c, progress));
}

/* The times a and the log2 b of activation, which learns five times as fast. */
static void expect_spans(course c, double progress)
{
    const int first = trainer.layout.first[TED4_TAU];

    for (int i = 0; i < 4; i += 2) {
        expect_channels("span", first + i, 1, c, progress);
        expect_channels("width", first + i + 1, 1, (course) { 5 * c.first, 5 * c.last }, progress);
    }
}

/* In stage 1, masks of offsets stay open, and activation is learnt only after the static phase. A
 * mask has 60,000 steps to close in the published recipe; in fewer steps it moves faster. */
static void test_anchors_stage1(void **state)
{
    const ted4_train_options *o = &cloud.options;
    const ted4_layout *l = &trainer.layout;
    const double pace = 60000.0 / STAGE1 * o->lr_mask / 3;

    (void)state;
    for (double p = 0; p <= 1; p += 0.5) {
        go(1, p);
        expect_channels("feature", l->first[TED4_FEATURE], l->head.feature_dim,
                        (course) { o->lr_feature, o->lr_feature }, p);
        expect_channels("scaling", l->first[TED4_SCALING], 6,
                        (course) { o->lr_scaling, o->lr_scaling }, p);
        expect_channels("offset", l->first[TED4_OFFSET], 3 * l->head.n_offsets,
                        (course) { o->lr_offset, 0.01 * o->lr_offset }, p);
        expect_channels("phi", l->first[TED4_PHI], l->head.phi_dim,
                        (course) { o->lr_phi, o->lr_phi }, p);
        expect_channels("offset mask", l->offset_logit, l->head.n_offsets, (course) { 0, 0 }, p);
        expect_channels("temporal mask", l->temporal_logit, 1, (course) { pace, 0.01 * pace }, p);
    }
    trainer.iteration = ted4_activation_step(o) - 1;
    expect_spans((course) { 0, 0 }, 0);
    trainer.iteration++;
    expect_spans((course) { o->lr_tau, 0.1 * o->lr_tau }, (double)trainer.iteration / STAGE1);
}

/* Stage 2 begins again, at a third of the rates; offsets at a tenth. A mask has 30,000 steps to
 * close, and is at most ten times as fast in fewer: here, with 2,000, it would be fifteen times. */
static void test_anchors_stage2(void **state)
{
    const ted4_train_options *o = &cloud.options;
    const ted4_layout *l = &trainer.layout;
    const double mask = 10 * o->lr_mask;

    (void)state;
    for (double p = 0; p <= 1; p += 0.5) {
        go(2, p);
        expect_channels("feature", l->first[TED4_FEATURE], l->head.feature_dim,
                        (course) { o->lr_feature / 3, o->lr_feature / 30 }, p);
        expect_channels("scaling", l->first[TED4_SCALING], 6,
                        (course) { o->lr_scaling / 3, o->lr_scaling / 30 }, p);
        expect_channels("offset", l->first[TED4_OFFSET], 3 * l->head.n_offsets,
                        (course) { o->lr_offset / 10, o->lr_offset / 100 }, p);
        expect_channels("phi", l->first[TED4_PHI], l->head.phi_dim,
                        (course) { o->lr_phi / 3, o->lr_phi / 30 }, p);
        expect_spans((course) { o->lr_tau / 3, o->lr_tau / 30 }, p);
        expect_channels("offset mask", l->offset_logit, l->head.n_offsets,
                        (course) { mask, 0.01 * mask }, p);
        expect_channels("temporal mask", l->temporal_logit, 1,
                        (course) { mask / 3, 0.01 * mask / 3 }, p);
    }
}

/* Linear scalings move by a fifth of their quantisation step: that of the options if they ask for
 * linear scalings, that of the header if a trial chose them. */
static void test_linear_scalings(void **state)
{
    const int first = trainer.layout.first[TED4_SCALING];

    (void)state;
    go(1, 0);
    trainer.layout.head.scale_domain = TED4_SCALE_LINEAR;
    trainer.layout.head.step[TED4_SCALING] = 0.25f;
    expect_channels("linear scaling", first, 6, (course) { 0.05, 0.05 }, 0);
    trainer.opt.linear_scale = 1;
    trainer.opt.step_scaling = 0.5;
    expect_channels("linear scaling", first, 6, (course) { 0.1, 0.1 }, 0);
    trainer.opt.linear_scale = cloud.options.linear_scale;
    trainer.opt.step_scaling = cloud.options.step_scaling;
    trainer.layout.head.scale_domain = TED4_SCALE_LOG2;
}

/* Checks all ranges of networks; prior: the rate of the prior's networks, 0 if they have none. */
static void expect_networks(double heads, double motion, double bank, double prior)
{
    ted4_net_range range[TED4_NET_RANGES];
    const ted4_layout *l = &trainer.layout;
    const int n = ted4_schedule_network(&trainer, range);
    size_t covered = 0;

    assert_int_equal(n, TED4_NETS_R + 1 + (prior > 0));
    for (int i = 0; i < TED4_NETS_R; i++) {
        const int moves = i == TED4_NET_PROJECT || i == TED4_NET_DEFORM;

        assert_int_equal(range[i].first, l->netr + l->shape.netr[i].first);
        expect_rate("network", (double)range[i].rate, moves ? motion : heads);
        covered += range[i].n;
    }
    assert_int_equal(range[TED4_NETS_R].first, l->bank);
    assert_int_equal(range[TED4_NETS_R].n, l->shape.n_bank);
    expect_rate("bank", (double)range[TED4_NETS_R].rate, bank);
    covered += range[TED4_NETS_R].n;
    if (prior > 0) {
        assert_int_equal(range[n - 1].first, l->nete);
        assert_int_equal(range[n - 1].n, l->shape.n_nete);
        expect_rate("prior", (double)range[n - 1].rate, prior);
        covered += range[n - 1].n;
    }
    assert_int_equal(covered, prior > 0 ? l->n_net : l->n_net - l->shape.n_nete);
}

static void test_networks(void **state)
{
    const ted4_train_options *o = &cloud.options;

    (void)state;
    for (int stage = 1; stage <= 2; stage++)
        for (double p = 0; p <= 1; p += 0.5) {
            const double share = stage == 1 ? 1 : 1.0 / 3;
            const double motion = share * at((course) { o->lr_motion, 0.1 * o->lr_motion }, p);

            go(stage, p);
            expect_networks(share * at((course) { o->lr_heads, 0.02 * o->lr_heads }, p), motion,
                            motion,
                            stage == 1 ? 0 : at((course) { o->lr_prior, 0.02 * o->lr_prior }, p));
        }
}

/* In the integer stage, the prior learns no more, and neither do weights on a coarse grid. */
static void test_integer_stage(void **state)
{
    const double heads = cloud.options.lr_heads / 3, motion = cloud.options.lr_motion / 3;
    static const ted4_weight_grid grids[] = { TED4_WEIGHT_GRID_HEADS, TED4_WEIGHT_GRID_MOTION,
                                              TED4_WEIGHT_GRID_BANK };

    (void)state;
    go(2, 0);
    trainer.phase.integer = 1;
    expect_networks(heads, motion, motion, 0);
    for (int i = 0; i < 3; i++) {
        trainer.net.bits[grids[i]] = 6;
        expect_networks(i == 0 ? 0 : heads, i == 1 ? 0 : motion, i == 2 ? 0 : motion, 0);
        ted4_weight_grid_full(trainer.net.bits);
    }
}

/* After a rollback, all rates are smaller by the same factor. */
static void test_factor(void **state)
{
    float before[CHANNELS] = { 0 }, after[CHANNELS] = { 0 };
    ted4_net_range networks[2][TED4_NET_RANGES];
    int n = 0;

    (void)state;
    go(2, 0.25);
    ted4_schedule_rates(&trainer, before);
    n = ted4_schedule_network(&trainer, networks[0]);
    trainer.monitor.state.factor = 0.25;
    ted4_schedule_rates(&trainer, after);
    assert_int_equal(ted4_schedule_network(&trainer, networks[1]), n);
    trainer.monitor.state.factor = 1;
    for (int c = 0; c < trainer.layout.n_channels; c++)
        assert_true(before[c] > 0 && after[c] == 0.25f * before[c]);
    for (int i = 0; i < n; i++)
        assert_true(networks[0][i].rate > 0 && networks[1][i].rate == 0.25f * networks[0][i].rate);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_anchors_stage1),  cmocka_unit_test(test_anchors_stage2),
        cmocka_unit_test(test_linear_scalings), cmocka_unit_test(test_networks),
        cmocka_unit_test(test_integer_stage),   cmocka_unit_test(test_factor),
    };

    return cmocka_run_group_tests(tests, set_up, tear_down);
}
