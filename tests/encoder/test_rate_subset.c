/* test_rate_subset.c - train/step/apply_gradients.c, the rate terms of a step: they are evaluated
 * on a random share of the blocks, every block equally often, and their mean is the gradient of all
 * blocks; lambda multiplies the mean bits per parameter; results are bit-identical for any number
 * of threads.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <stdlib.h>

#include "test.h"
#include "cloud_case.h"
#include "odd_threads.h"
#include "tool/threads.h"
#include "train/state/visible_blocks.h"
#include "train/step/loss_terms.h"
#include "train/step/stages.h"
#include "train/step/trainer_init.h"

/* 216 anchors in 7 blocks, of which a share of 0.15 is 2 blocks. */
enum { BLOCKS = (CLOUD_POINTS + TED4_LANES - 1) / TED4_LANES, CHOSEN = 2, KEYS = 700 };
#define SHARE 0.15

static cloud_case cloud;

/* Begins stage 2, with all anchors. */
static void begin(ted4_trainer *t, const ted4_parallel *p)
{
    cloud_make(&cloud, 5);
    cloud.options.prune_opacity = 0;
    cloud.options.lambda = 4;
    if (ted4_trainer_init(t, &cloud.options, &cloud.data, p) != 0 || ted4_stage2_begin(t) != 0)
        fail_msg("%s", t->message.text);
    assert_int_equal(t->anchors.n, CLOUD_POINTS);
    assert_int_equal(t->anchors.n_blocks, BLOCKS);
}

/* Computes the gradients of the rate, added to a gradient d_value of every value. If that is not 0,
 * it reaches the step sizes too. */
static void run(ted4_trainer *t, uint64_t key, double share, float d_value)
{
    const size_t floats = (size_t)t->layout.n_channels * TED4_LANES;

    t->opt.rate_share = share;
    memset(t->progress.bits, 0, sizeof t->progress.bits);
    assert_int_equal(ted4_visible_blocks_fill(t, NULL), 0);
    assert_int_equal(t->visible_blocks.n, BLOCKS);
    for (size_t i = 0; i < t->visible_blocks.n * floats; i++)
        t->visible_blocks.gradients[i] = d_value;
    memset(t->net.gradient, 0, t->layout.n_net * sizeof *t->net.gradient);
    if (ted4_update_rate(t, key) != 0)
        fail_msg("%s", t->message.text);
}

/* Sum of the gradients of a block's offset masks: bits of offsets times the slope of the sigmoid,
 * or 0 for blocks that were not chosen. */
static double of_masks(const ted4_trainer *t, size_t visible)
{
    double sum = 0;

    for (int c = t->layout.offset_logit; c < t->layout.temporal_logit; c++)
        for (int j = 0; j < TED4_LANES; j++)
            sum += (double)t->visible_blocks.gradient[visible][c * TED4_LANES + j];
    return sum;
}

/* ---- which blocks ---- */

/* All that belongs to a visible block moves with it. All blocks are visible, so that the Gaussians
 * of block b are those with this number. */
static void check_moved(const ted4_trainer *t, size_t visible)
{
    const ted4_visible_blocks *s = &t->visible_blocks;
    const size_t b = s->block[visible], floats = (size_t)t->layout.n_channels * TED4_LANES;

    assert_int_equal(s->drawn[visible], b);
    assert_int_equal(s->lanes[visible], ted4_block_lanes(&t->anchors, b));
    assert_ptr_equal(s->raw[visible], ted4_block(&t->anchors, TED4_ROW_VALUE, b));
    assert_ptr_equal(s->position[visible], ted4_block(&t->anchors, TED4_ROW_POSITION, b));
    assert_ptr_equal(s->steps[visible], ted4_block(&t->anchors, TED4_ROW_STEP, b));
    assert_ptr_equal(s->gradient[visible], s->gradients + b * floats);
    assert_ptr_equal(s->used[visible], s->quantised + b * floats);
}

static void test_choice(void **state)
{
    ted4_trainer t;
    int often[BLOCKS] = { 0 };

    (void)state;
    begin(&t, NULL);
    for (uint64_t key = 0; key < KEYS; key++) {
        int n = 0, seen[BLOCKS] = { 0 };

        run(&t, ted4_mix(key), SHARE, 0);
        for (size_t i = 0; i < BLOCKS; i++) {
            const int chosen = of_masks(&t, i) > 0;

            assert_int_equal(seen[t.visible_blocks.block[i]]++, 0);
            check_moved(&t, i);
            often[t.visible_blocks.block[i]] += chosen;
            n += chosen;
        }
        assert_int_equal(n, CHOSEN);
    }
    /* Each is chosen 200 times on average, with a standard deviation of 12. */
    for (int b = 0; b < BLOCKS; b++)
        if (abs(often[b] - KEYS * CHOSEN / BLOCKS) > 60)
            fail_msg("block %d was chosen %d times of %d", b, often[b], KEYS);
    ted4_trainer_finish(&t);
}

/* ---- weights ---- */

/* The rate is lambda times the mean bits per parameter, absent ones included, over the evaluated
 * anchors. All mask logits are 1. */
static void test_weight(void **state)
{
    static const double shares[] = { SHARE, 1 };
    const double slope = 1 / (1 + exp(-1.0)) * (1 - 1 / (1 + exp(-1.0)));
    ted4_trainer t;
    double params = 0;

    (void)state;
    begin(&t, NULL);
    for (int y = 0; y < TED4_TYPES; y++)
        params += t.layout.shape.dim[y];
    for (int k = 0; k < 2; k++) {
        double sum = 0, bits;

        run(&t, 5, shares[k], 0);
        for (size_t i = 0; i < BLOCKS; i++)
            sum += of_masks(&t, i);
        bits = t.progress.bits[TED4_OFFSET] / 0.02; /* per anchor; first step of a running mean */
        if (!(bits > 5 && fabs(sum - t.opt.lambda * slope * bits / params) < 1e-4 * sum))
            fail_msg("share %g: %g for %g bits an anchor of %g parameters", shares[k], sum, bits,
                     params);
    }
    ted4_trainer_finish(&t);
}

/* Twice the lambda gives exactly twice every gradient. */
static void test_lambda(void **state)
{
    ted4_trainer t;

    (void)state;
    begin(&t, NULL);
    const size_t n = t.layout.n_net;
    float *once = malloc(n * sizeof *once);

    assert_non_null(once);
    run(&t, 9, SHARE, 0);
    memcpy(once, t.net.gradient, n * sizeof *once);
    t.opt.lambda *= 2;
    run(&t, 9, SHARE, 0);
    for (size_t i = 0; i < n; i++)
        assert_true(t.net.gradient[i] == 2 * once[i]);
    free(once);
    ted4_trainer_finish(&t);
}

/* Ratio, by least squares, of a share's gradient to that of all blocks, summed over keys, for the
 * biases that determine the step sizes. */
static double factor(ted4_trainer *t, float d_value)
{
    const ted4_shape *s = &t->layout.shape;
    const int last = s->hyper.n_layers - 1;
    size_t at = t->layout.nete + s->hyper.first;
    double product = 0, square = 0;
    float all[TED4_TYPES];

    for (int i = 0; i < last; i++)
        at += ((size_t)s->hyper.dim[i] + 1) * s->hyper.dim[i + 1];
    at += (size_t)s->hyper.dim[last] * s->n_outputs + s->first_step_output;
    for (uint64_t key = 0; key < KEYS; key++) {
        run(t, ted4_mix(key), 1, d_value);
        memcpy(all, t->net.gradient + at, s->n_types * sizeof *all);
        run(t, ted4_mix(key), SHARE, d_value);
        for (size_t y = 0; y < s->n_types; y++) {
            product += (double)all[y] * (double)t->net.gradient[at + y];
            square += (double)all[y] * (double)all[y];
        }
    }
    assert_true(square > 0);
    return product / square;
}

/* For the gradients of the step sizes both from the bits and from the picture. */
static void test_mean(void **state)
{
    ted4_trainer t;

    (void)state;
    begin(&t, NULL);
    const double rate = factor(&t, 0);

    t.opt.lambda = 0;
    const double distortion = factor(&t, 1);

    if (!(fabs(rate - 1) < 0.1 && fabs(distortion - 1) < 0.15))
        fail_msg("the share is worth %g of the rate, %g of the distortion", rate, distortion);
    ted4_trainer_finish(&t);
}

/* ---- threads ---- */

static void test_threads(void **state)
{
    ted4_parallel how[3] = { { odd_backwards, NULL }, { odd_threads, NULL } };
    ted4_trainer alone, t;

    (void)state;
    ted4_threads_init(&how[2], 2);
    begin(&alone, NULL);
    run(&alone, 3, 0.6, 0.5f);
    for (int i = 0; i < 3; i++) {
        const size_t floats = (size_t)alone.layout.n_channels * TED4_LANES;

        begin(&t, &how[i]);
        run(&t, 3, 0.6, 0.5f);
        assert_memory_equal(t.net.gradient, alone.net.gradient,
                            t.layout.n_net * sizeof *t.net.gradient);
        assert_memory_equal(t.visible_blocks.gradients, alone.visible_blocks.gradients,
                            BLOCKS * floats * sizeof(float));
        assert_memory_equal(t.visible_blocks.block, alone.visible_blocks.block,
                            BLOCKS * sizeof *t.visible_blocks.block);
        assert_memory_equal(t.anchors.data[TED4_ROW_STEP], alone.anchors.data[TED4_ROW_STEP],
                            BLOCKS * TED4_TYPES * TED4_LANES * sizeof(float));
        assert_memory_equal(&t.progress, &alone.progress, sizeof t.progress);
        ted4_trainer_finish(&t);
    }
    ted4_trainer_finish(&alone);
    ted4_threads_finish(&how[2]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_choice),  cmocka_unit_test(test_weight),
        cmocka_unit_test(test_lambda),  cmocka_unit_test(test_mean),
        cmocka_unit_test(test_threads),
    };

    return cmocka_run_group_tests_name("rate subset", tests, NULL, NULL);
}
