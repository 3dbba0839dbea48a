/* test_terms.c - the objectives of a training step (paper, "Training Objectives"): a larger weight
 * of any term of the loss, in a training from pictures, reduces the quantity that the term
 * penalises; the prior and its step sizes are learnt; and every part of the model is trained in its
 * phases and only then. Values of the terms: test_update.c, test_rate_subset.c, test_step_grad.c.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "test.h"
#include "ball_group.h"
#include "train/monitor/checkpoint.h"
#include "train/step/stages.h"

enum { STAGE1 = 150, STAGE2 = 200 };

static ted4_train_options options(const char *changed)
{
    ted4_train_options o = ball_options();

    ball_set(&o, "stage1=150");
    ball_set(&o, "stage2=200");
    ball_set(&o, changed);
    return o;
}

/* ---- quantities that terms penalise ---- */

static double mean_of(const ted4_trainer *t, int first, int n)
{
    double sum = 0;

    for (size_t i = 0; i < t->anchors.n; i++)
        for (int c = first; c < first + n; c++)
            sum += (double)*ted4_anchor_value(&t->anchors, TED4_ROW_VALUE, i, c);
    return sum / ((double)t->anchors.n * n);
}

/* Mean log2 of the sizes of Gaussians, before the heads modify them. */
static double log_size(const ted4_trainer *t)
{
    return mean_of(t, t->layout.first[TED4_SCALING] + 3, 3);
}

static double roughness(const ted4_trainer *t)
{
    const size_t D = t->layout.head.bank_dim, M = t->layout.head.bank_rows;
    const float *z = t->net.value + t->layout.bank;
    double sum = 0;

    for (size_t i = 0; i + 2 < M; i++)
        for (size_t c = 0; c < D; c++)
            sum += pow((double)(z[i * D + c] - 2 * z[(i + 1) * D + c] + z[(i + 2) * D + c]), 2);
    return sqrt(sum / (double)((M - 2) * D));
}

static double pull_to_move(const ted4_trainer *t)
{
    return mean_of(t, t->layout.temporal_logit, 1);
}

static double pull_to_keep(const ted4_trainer *t)
{
    return mean_of(t, t->layout.offset_logit, t->layout.head.n_offsets);
}

/* ln(1 - SSIM): the logarithm, because this falls by orders of magnitude as training proceeds. */
static double unlike(const ted4_trainer *t)
{
    return log(1 - t->progress.ssim);
}

/* Bits per anchor, as in the file. */
static double bits(const ted4_trainer *t)
{
    double estimate[TED4_TYPES], sum = 0;

    assert_int_equal(ted4_integer_rate((ted4_trainer *)(uintptr_t)t, estimate), 0);
    for (int y = 0; y < TED4_TYPES; y++)
        sum += estimate[y];
    return sum / (double)t->anchors.n;
}

/* The negative mean distance between log2 of the features' steps and log2 of Q0. */
static double sameness(const ted4_trainer *t)
{
    const double q0 = (double)t->layout.head.step[TED4_FEATURE];
    double sum = 0;

    for (size_t i = 0; i < t->anchors.n; i++)
        sum -= fabs(
            log2((double)*ted4_anchor_value(&t->anchors, TED4_ROW_STEP, i, TED4_FEATURE) / q0));
    return sum / (double)t->anchors.n;
}

/* No common option: a value that options() sets anyway. */
#define NONE "slices=2"

typedef struct {
    const char *light, *heavy, *both;
    double (*what)(const ted4_trainer *t); /* to be reduced */
    double least;                          /* smallest reduction from light to heavy */
} term;

static double trained(const term *x, int heavy, const ted4_snapshot *from)
{
    ted4_train_options o = options(heavy ? x->heavy : x->light);
    ted4_trainer t;
    double found;

    ball_set(&o, x->both);
    ball_begin(&t, &o, &balls, NULL);
    if (from != NULL && ted4_snapshot_restore(&t, from) != 0)
        fail_msg("%s", t.message.text);
    ball_train(&t, (uint64_t)o.stage1 + (from != NULL ? (uint64_t)o.stage2 : 0));
    found = x->what(&t);
    ted4_trainer_finish(&t);
    return found;
}

static void check(const term *x, size_t n, const ted4_snapshot *from)
{
    for (size_t i = 0; i < n; i++) {
        const double light = trained(&x[i], 0, from), heavy = trained(&x[i], 1, from);

        if (!(heavy < light - x[i].least))
            fail_msg("%s: %g, %s: %g", x[i].light, light, x[i].heavy, heavy);
    }
}

static void test_stage1(void **state)
{
    static const term terms[] = {
        { "volume_weight=0", "volume_weight=100", "lr_heads=0", log_size, 0.05 },
        { "tv_weight=0", "tv_weight=100", NONE, roughness, 0.05 },
        { "temporal_weight=0", "temporal_weight=1", NONE, pull_to_move, 0.5 },
        /* At least 0.25 for all seeds tried; after 150 steps the difference would not be
         * reliable. */
        { "ssim=0", "ssim=1", "stage1=800", unlike, 0.05 },
    };

    (void)state;
    check(terms, sizeof terms / sizeof terms[0], NULL);
}

static void test_stage2(void **state)
{
    static const term terms[] = {
        { "mask_weight=0", "mask_weight=100", NONE, pull_to_keep, 0.5 },
        { "lambda=0.0001", "lambda=0.1", NONE, bits, 20 },
        { "lr_prior=0", "lr_prior=0.02", NONE, bits, 3 },
        { "lr_prior=0", "lr_prior=0.02", NONE, sameness, 0.1 },
    };
    const ted4_train_options o = options("stage1=150");
    ted4_snapshot from = { 0 };
    ted4_trainer t;

    (void)state;
    ball_begin(&t, &o, &balls, NULL);
    ball_train(&t, STAGE1);
    assert_int_equal(ted4_snapshot_take(&t, &from), 0);
    ted4_trainer_finish(&t);
    check(terms, sizeof terms / sizeof terms[0], &from);
    ted4_snapshot_free(&from);
}

/* ---- which parts are trained when ---- */

/* Parts of the model, one bit each: the five networks, bank, prior; the five types of values, masks
 * of offsets, masks of motion. */
enum {
    NETS = 1 << TED4_NETS_R,
    BANK = NETS,
    PRIOR = NETS << 1,
    TYPES = NETS << 2,
    TAU = TYPES << TED4_TAU,
    OFFSET_MASK = TYPES << TED4_TYPES,
    TEMPORAL_MASK = OFFSET_MASK << 1,
    ALL = (TEMPORAL_MASK << 1) - 1,
    STEPS = 8
};

static int differs(const float *a, const float *b, size_t first, size_t n)
{
    return memcmp(a + first, b + first, n * sizeof *a) != 0;
}

static int channels_differ(const ted4_trainer *t, const float *before, int first, int n)
{
    for (size_t b = 0; b < t->anchors.n_blocks; b++)
        if (differs(t->anchors.data[TED4_ROW_VALUE], before,
                    (b * (size_t)t->layout.n_channels + (size_t)first) * TED4_LANES,
                    (size_t)n * TED4_LANES))
            return 1;
    return 0;
}

/* Trains some steps. Returns the parts that they change. */
static int moved(ted4_trainer *t)
{
    const ted4_layout *l = &t->layout;
    const ted4_shape *s = &l->shape;
    const size_t values = t->anchors.n_blocks * (size_t)l->n_channels * TED4_LANES,
                 anchors = t->anchors.n;
    float *net = malloc(l->n_net * sizeof *net), *value = malloc(values * sizeof *value);
    int parts = 0;

    assert_non_null(net);
    assert_non_null(value);
    memcpy(net, t->net.value, l->n_net * sizeof *net);
    memcpy(value, t->anchors.data[TED4_ROW_VALUE], values * sizeof *value);
    ball_train(t, t->iteration + STEPS);
    assert_int_equal(t->anchors.n, anchors);
    for (int i = 0; i < TED4_NETS_R; i++) {
        const size_t end = i + 1 < TED4_NETS_R ? s->netr[i + 1].first : s->n_netr;

        parts |= differs(t->net.value, net, l->netr + s->netr[i].first, end - s->netr[i].first)
                 << i;
    }
    parts |= differs(t->net.value, net, l->bank, s->n_bank) ? BANK : 0;
    parts |= differs(t->net.value, net, l->nete, s->n_nete) ? PRIOR : 0;
    for (int y = 0; y < TED4_TYPES; y++)
        parts |= channels_differ(t, value, l->first[y], (int)s->dim[y]) ? TYPES << y : 0;
    parts |= channels_differ(t, value, l->offset_logit, l->head.n_offsets) ? OFFSET_MASK : 0;
    parts |= channels_differ(t, value, l->temporal_logit, 1) ? TEMPORAL_MASK : 0;
    free(net);
    free(value);
    return parts;
}

/* Phases between adjustments of anchors: static, with activation, with the rate, and with the
 * integer model. */
static void test_turns(void **state)
{
    static const struct {
        uint64_t step;
        int parts;
    } turns[] = {
        { 10, ALL & ~(PRIOR | TAU | OFFSET_MASK) },
        { STAGE1 - 20, ALL & ~(PRIOR | OFFSET_MASK) },
        { STAGE1 + 5, ALL },
        { STAGE1 + STAGE2 - 20, ALL & ~PRIOR },
    };
    const ted4_train_options o = options("stage1=150");
    ted4_trainer t;

    (void)state;
    ball_begin(&t, &o, &balls, NULL);
    for (size_t i = 0; i < sizeof turns / sizeof turns[0]; i++) {
        ball_train(&t, turns[i].step);
        const int parts = moved(&t);

        if (parts != turns[i].parts)
            fail_msg("from step %d on: parts %x moved, expected %x", (int)turns[i].step,
                     (unsigned)parts, (unsigned)turns[i].parts);
    }
    ted4_trainer_finish(&t);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_stage1),
        cmocka_unit_test(test_stage2),
        cmocka_unit_test(test_turns),
    };

    return cmocka_run_group_tests_name("terms", tests, set_up, tear_down);
}
