/* test_stage_starts.c - what begins with a stage: Adam starts anew in stage 2, for anchors and for
 * networks, parts of the model that hardly any anchor uses are dropped, and the search and the
 * integer stage begin at their steps. Built by hand, without training.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cloud_case.h"
#include "test.h"
#include "train/search/model_search.h"
#include "train/state/visible_blocks.h"
#include "train/step/apply_gradients.h"
#include "train/step/events.h"
#include "train/step/schedule.h"
#include "train/step/stages.h"

enum { STAGE1 = 1000, STAGE2 = 250, FRAMES = 5 };

#define GRADIENT 0.5f

static cloud_case cloud;

/* Begins a trainer that has done all steps of stage 1, with moments of Adam as large ones. */
static void begin(ted4_trainer *t)
{
    cloud_make(&cloud, FRAMES);
    cloud.options.stage1 = STAGE1;
    cloud.options.stage2 = STAGE2;
    cloud.options.capacity = 0;
    cloud_begin(&cloud, t);
    for (int r = TED4_ROW_M; r <= TED4_ROW_V; r++)
        for (size_t i = 0; i < t->anchors.n_blocks * (size_t)t->layout.n_channels * TED4_LANES; i++)
            t->anchors.data[r][i] = 1.0f;
    for (size_t i = 0; i < t->layout.n_net; i++)
        t->net.m[i] = t->net.v[i] = 1.0f;
    t->iteration = STAGE1;
}

static float *copy(const float *x, size_t n)
{
    float *y = malloc(n * sizeof *y);

    assert_non_null(y);
    memcpy(y, x, n * sizeof *y);
    return y;
}

/* Asserts that x[n] has moved down by rate from what it was. The first steps of Adam on a constant
 * gradient move by the rate, if moments and their bias correction began together; on moments of 0,
 * the bias correction of a later step would make them 2.5 times as long. */
static void expect_moved(const float *x, const float *before, size_t n, float rate)
{
    for (size_t i = 0; i < n; i++)
        if (!(fabsf(before[i] - x[i] - rate) <= 0.01f * rate + 1e-6f * fabsf(x[i])))
            fail_msg("number %zu moved by %g, rate %g", i, (double)(before[i] - x[i]),
                     (double)rate);
}

/* Does one update with the same gradient everywhere, and checks all that learns. */
static void check_update(ted4_trainer *t)
{
    const size_t floats = t->anchors.n_blocks * (size_t)t->layout.n_channels * TED4_LANES;
    float *anchors = copy(t->anchors.data[TED4_ROW_VALUE], floats),
          *net = copy(t->net.value, t->layout.n_net), *rate = calloc(512, sizeof *rate);
    ted4_net_range range[TED4_NET_RANGES];
    int learnt = 0;

    assert_non_null(rate);
    assert_true(t->layout.n_channels <= 512);
    assert_int_equal(ted4_visible_blocks_fill(t, NULL), 0);
    assert_int_equal(t->visible_blocks.n, t->anchors.n_blocks);
    for (size_t i = 0; i < floats; i++)
        t->visible_blocks.gradients[i] = GRADIENT;
    for (size_t i = 0; i < t->layout.n_net; i++)
        t->net.gradient[i] = GRADIENT;
    ted4_schedule_rates(t, rate);

    const int ranges = ted4_schedule_network(t, range);

    ted4_update_parameters(t, 1);
    for (size_t b = 0; b < t->anchors.n_blocks; b++)
        for (int c = 0; c < t->layout.n_channels; c++) {
            const size_t at = (b * (size_t)t->layout.n_channels + (size_t)c) * TED4_LANES;

            expect_moved(t->anchors.data[TED4_ROW_VALUE] + at, anchors + at, TED4_LANES, rate[c]);
            learnt += rate[c] > 0;
        }
    assert_true(learnt > 0);
    for (int i = 0; i < ranges; i++)
        expect_moved(t->net.value + range[i].first, net + range[i].first, range[i].n,
                     range[i].rate);
    free(anchors);
    free(net);
    free(rate);
}

static void test_adam_restarts(void **state)
{
    ted4_trainer t;

    (void)state;
    begin(&t);
    assert_int_equal(ted4_stage2_begin(&t), 0);
    assert_int_equal(t.phase.stage2_start, STAGE1);
    for (int step = 0; step < 3; step++, t.iteration++)
        check_update(&t);
    ted4_trainer_finish(&t);
}

/* Asserts that the integer stage begins just before the step at this iteration, once. */
static void check_integer_step(double share, uint64_t step)
{
    ted4_trainer t;

    begin(&t);
    t.opt.integer_share = share;
    t.iteration = step;
    assert_false(ted4_integer_due(&t)); /* not within stage 1, whatever its length */
    t.iteration = STAGE1;
    assert_int_equal(ted4_stage2_begin(&t), 0);
    for (t.iteration = STAGE1; t.iteration < step; t.iteration++) {
        assert_false(ted4_integer_due(&t));
        assert_int_equal(ted4_schedule_event(&t), 0);
        assert_false(t.phase.integer);
    }
    assert_true(ted4_integer_due(&t));
    assert_int_equal(ted4_schedule_event(&t), 0);
    assert_true(t.phase.integer);
    assert_false(ted4_integer_due(&t));
    ted4_trainer_finish(&t);
}

/* Of 250 steps, 200 come before the last fifth; 187 before the last quarter, as steps are whole. */
static void test_integer_step(void **state)
{
    (void)state;
    check_integer_step(0.2, STAGE1 + 200);
    check_integer_step(0.25, STAGE1 + 187);
    check_integer_step(1, STAGE1);
}

/* The model search comes after 15 % of stage 2, if there is any. */
static void test_search_step(void **state)
{
    ted4_trainer t;

    (void)state;
    begin(&t);
    assert_true(ted4_model_search_due_step(&t) == UINT64_MAX);
    t.opt.capacity = 1;
    assert_int_equal(ted4_model_search_due_step(&t), STAGE1 + 37);
    t.opt.stage2 = 0;
    assert_true(ted4_model_search_due_step(&t) == UINT64_MAX);
    ted4_trainer_finish(&t);
}

enum { COPIES = 10, MANY = COPIES * CLOUD_POINTS };

/* Makes 2,160 anchors of 216: copies lie beside each other. All of them are still and always there.
 */
static void multiply_anchors(ted4_trainer *t)
{
    static const float always[4] = { 0, 5, 1, 5 };
    const size_t n = t->anchors.n;

    assert_int_equal(n, CLOUD_POINTS);
    assert_int_equal(ted4_anchors_resize(&t->anchors, MANY), 0);
    for (size_t i = 0; i < MANY; i++) {
        for (int c = 0; c < t->layout.n_channels; c++)
            *ted4_anchor_value(&t->anchors, TED4_ROW_VALUE, i, c) =
                *ted4_anchor_value(&t->anchors, TED4_ROW_VALUE, i % n, c);
        for (int j = 0; j < 3; j++)
            *ted4_anchor_value(&t->anchors, TED4_ROW_POSITION, i, j) =
                *ted4_anchor_value(&t->anchors, TED4_ROW_POSITION, i % n, j) +
                0.004f * (float)(j == 0 ? i / n : 0);
        for (int c = 0; c < 4; c++)
            *ted4_anchor_value(&t->anchors, TED4_ROW_VALUE, i, t->layout.first[TED4_TAU] + c) =
                always[c];
        *ted4_anchor_value(&t->anchors, TED4_ROW_VALUE, i, t->layout.temporal_logit) = -10.0f;
    }
}

/* Of 2,160 anchors, four are 0.19 % and five 0.23 %: what at most 0.2 % of all anchors do is not
 * worth a part of the model. moving, fading: numbers of anchors that move, or that are absent at
 * first. */
static void check_parts(size_t moving, size_t fading)
{
    static const float late[4] = { 0.5f, -3, 1, 5 };
    ted4_trainer t;

    begin(&t);
    t.opt.prune_opacity = 0;
    multiply_anchors(&t);
    for (size_t i = 0; i < moving; i++)
        *ted4_anchor_value(&t.anchors, TED4_ROW_VALUE, 7 * i, t.layout.temporal_logit) = 1.0f;
    for (size_t i = 0; i < fading; i++)
        for (int c = 0; c < 4; c++)
            *ted4_anchor_value(&t.anchors, TED4_ROW_VALUE, 7 * i, t.layout.first[TED4_TAU] + c) =
                late[c];
    assert_int_equal(ted4_stage2_begin(&t), 0);
    assert_int_equal(t.anchors.n, MANY);
    assert_int_equal(t.layout.head.motion, moving > 4 ? TED4_MOTION_BANK : TED4_MOTION_NONE);
    assert_int_equal(t.layout.head.activation, fading > 4);
    ted4_trainer_finish(&t);
}

static void test_parts(void **state)
{
    (void)state;
    check_parts(4, 5);
    check_parts(5, 4);
    check_parts(0, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_adam_restarts),
        cmocka_unit_test(test_integer_step),
        cmocka_unit_test(test_search_step),
        cmocka_unit_test(test_parts),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
