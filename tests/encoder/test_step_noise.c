/* test_step_noise.c - one noise per step: the values that are rendered and those whose bits are
 * estimated have the same noise, drawn from the seed and the number of the step.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <math.h>
#include <stdlib.h>

#define BALL_FRAMES 3
#include "ball_group.h"
#include "test.h"
#include "train/math/random.h"
#include "train/monitor/checkpoint.h"

enum { STAGE1 = 60, STEP = STAGE1 + 3, MOST_BLOCKS = 16 };

static ted4_train_options options;

static int set_up_all(void **state)
{
    options = ball_options();
    ball_set(&options, "stage1=60");
    ball_set(&options, "rate_share=1");
    return set_up(state);
}

/* The step's blocks as they were before it: t holds the parameters, and step has been done in
 * another trainer. */
typedef struct {
    const float *raw[MOST_BLOCKS], *position[MOST_BLOCKS];
    float *steps[MOST_BLOCKS];
} blocks;

static blocks blocks_before(const ted4_trainer *t, const ted4_visible_blocks *step)
{
    blocks b;

    assert_true(step->n > 1 && step->n <= MOST_BLOCKS);
    for (size_t i = 0; i < step->n; i++) {
        b.raw[i] = ted4_block(&t->anchors, TED4_ROW_VALUE, step->block[i]);
        b.position[i] = ted4_block(&t->anchors, TED4_ROW_POSITION, step->block[i]);
        b.steps[i] = ted4_block(&t->anchors, TED4_ROW_STEP, step->block[i]);
    }
    return b;
}

/* Bits per anchor of all types together, with the noise of a key. */
static double bits_with(ted4_trainer *t, const ted4_visible_blocks *step, uint64_t key)
{
    blocks b = blocks_before(t, step);
    double bits[TED4_TYPES], sum = 0, anchors = 0;
    const ted4_rate_input in = { &t->layout,
                                 t->net.value,
                                 NULL,
                                 step->n,
                                 b.raw,
                                 b.position,
                                 step->lanes,
                                 step->block,
                                 key,
                                 TED4_QUANT_NOISE,
                                 0.0f,
                                 0.0f,
                                 t->layout.head.activation,
                                 NULL };

    ted4_rate_pack(t->work.rate, t->net.value);
    assert_int_equal(ted4_rate_evaluate(t->work.rate, &in, NULL, NULL, NULL, NULL, b.steps, bits),
                     0);
    for (size_t i = 0; i < step->n; i++)
        anchors += __builtin_popcount(step->lanes[i]);
    for (int y = 0; y < TED4_TYPES; y++)
        sum += bits[y];
    return sum / anchors;
}

/* Whether the features that were rendered differ from those before by the noise of a key, in some
 * unit per anchor (its step size): for each anchor, all quotients of difference and noise agree. */
static int rendered_with(const ted4_trainer *t, const ted4_visible_blocks *step, uint64_t key)
{
    const blocks b = blocks_before(t, step);
    const ted4_layout *l = &t->layout;
    float *noise = malloc((size_t)l->n_channels * TED4_LANES * sizeof *noise);
    int same = 1;

    assert_non_null(noise);
    for (size_t i = 0; i < step->n; i++) {
        const size_t first = (size_t)l->first[TED4_FEATURE] * TED4_LANES;

        ted4_residuals(l, TED4_QUANT_NOISE, b.raw[i], b.steps[i], step->block[i], key, noise);
        for (size_t j = 0; j < TED4_LANES; j++)
            for (size_t at = first + j; at < first + l->head.feature_dim * (size_t)TED4_LANES;
                 at += TED4_LANES) {
                const double off = (double)(step->used[i][at] - b.raw[i][at]),
                             off0 = (double)(step->used[i][first + j] - b.raw[i][first + j]);

                if (step->lanes[i] >> j & 1)
                    same &= fabs(off * (double)noise[first + j] - off0 * (double)noise[at]) < 1e-4;
            }
    }
    free(noise);
    return same;
}

static double sum_of(const double bits[TED4_TYPES])
{
    double sum = 0;

    for (int y = 0; y < TED4_TYPES; y++)
        sum += bits[y];
    return sum;
}

static void test_same_noise(void **state)
{
    const uint64_t key = ted4_random(options.seed, STEP),
                   other = ted4_random(options.seed, STEP - 1);
    ted4_trainer t, before;
    ted4_snapshot s = { 0 };
    double old, now;

    (void)state;
    ball_begin(&t, &options, &balls, NULL);
    ball_train(&t, STEP);
    assert_int_equal(ted4_state_take(&t, &s), 0);
    ball_begin(&before, &options, &balls, NULL);
    assert_int_equal(ted4_state_restore(&before, &s), 0);
    old = sum_of(t.progress.bits);
    ball_train(&t, STEP + 1);
    /* progress is a running mean over 50 steps */
    now = old + 50 * (sum_of(t.progress.bits) - old);

    assert_true(rendered_with(&before, &t.visible_blocks, key));
    assert_false(rendered_with(&before, &t.visible_blocks, other));
    assert_true(fabs(now / bits_with(&before, &t.visible_blocks, key) - 1) < 1e-6);
    assert_false(fabs(now / bits_with(&before, &t.visible_blocks, other) - 1) < 1e-6);
    ted4_snapshot_free(&s);
    ted4_trainer_finish(&t);
    ted4_trainer_finish(&before);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_same_noise),
    };

    return cmocka_run_group_tests(tests, set_up_all, tear_down);
}
