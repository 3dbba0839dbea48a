/* test_model_search.c - train/search/model_search.c, prior_bits.c and rd_prune.c in a whole
 * training: their decisions lower the cost, stay within their budget, and are the same for any
 * number of threads and for an interrupted run; switched off, they have no effect.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "test.h"
#include "ball_trainer.h"
#include "odd_threads.h"
#include "train/search/file_cost.h"
#include "train/search/model_search.h"
#include "train/search/prior_bits.h"
#include "train/search/rd_prune.h"
#include "train/state/picture.h"
#include "train/monitor/checkpoint.h"
#include "train/step/events.h"
#include "train/step/export_scene.h"
#include "train/train.h"

enum { STAGE1 = 400, STAGE2 = 1400, TOTAL = STAGE1 + STAGE2, FRAMES = 5 };

static tiny_folder folder;
static ted4_dataset scene;
static ted4_snapshot stage1; /* at its end */

static ted4_train_options options(const char *capacity)
{
    ted4_train_options o = ball_options();

    ball_set(&o, capacity);
    ball_set(&o, "stage2=1400");
    ball_set(&o, "lambda=0.0005");
    ball_set(&o, "capacity_share=0.25");
    return o;
}

/* The weight of a bit is so high that, whatever was trained, coarse weights and a model without
 * motion save far more than they cost in quality: motion is dropped even at a quarter of this
 * weight. */
static ted4_train_options dear_options(void)
{
    ted4_train_options o = options("capacity=1");

    ball_set(&o, "lambda=0.05");
    return o;
}

static int set_up(void **state)
{
    const ted4_train_options o = options("capacity=1");
    ted4_trainer t;

    (void)state;
    ball_load(&folder, &scene, FRAMES, 1);
    ball_begin(&t, &o, &scene, NULL);
    ball_train(&t, STAGE1);
    assert_int_equal(ted4_snapshot_take(&t, &stage1), 0);
    ted4_trainer_finish(&t);
    return 0;
}

static int tear_down(void **state)
{
    (void)state;
    ted4_snapshot_free(&stage1);
    ted4_dataset_free(&scene);
    tiny_free(&folder);
    return 0;
}

/* Begins at the end of stage 1. */
static void begin(ted4_trainer *t, const ted4_train_options *o, const ted4_parallel *p)
{
    ball_begin(t, o, &scene, p);
    if (ted4_snapshot_restore(t, &stage1) != 0)
        fail_msg("%s", t->message.text);
}

static ball_file whole(const ted4_train_options *o, const ted4_parallel *p)
{
    ted4_trainer t;
    ball_file f;

    begin(&t, o, p);
    f = ball_finish(&t);
    ted4_trainer_finish(&t);
    return f;
}

static int is_of_bits(const struct ted4_trial *x)
{
    return x->candidate >= TED4_CANDIDATE_HEAD_BITS && x->candidate <= TED4_CANDIDATE_PRIOR_BITS;
}

/* Asserts that a trained trial was worth it, judged by the model that it was looked at with: four
 * fifths of the distortion that it added untrained would have to come back for a gain. */
static void check_worth(const ted4_trainer *t, const struct ted4_trial *trained)
{
    for (const struct ted4_trial *x = trained; x-- > t->search.trial;)
        if (x->candidate == trained->candidate && x->to == trained->to) {
            const double added = fmax(x->after.distortion - x->before.distortion, 0);

            assert_true(x->after.cost - 0.8 * added < x->before.cost);
            return;
        }
}

/* Asserts that each accepted trial lowers the cost and each rejected one does not. The first
 * reductions of the bits of the heads' weights save hundreds of bytes without a visible change, so
 * at least one trial is accepted. Returns the number of trials that were trained. */
static int check_trials(const ted4_trainer *t)
{
    int taken = 0, trained = 0;

    for (size_t i = 0; i < t->search.n_trials; i++) {
        const struct ted4_trial *x = &t->search.trial[i];

        assert_in_range(x->candidate, 0, TED4_CANDIDATES - 1);
        assert_true((x->to < x->from || x->candidate == TED4_CANDIDATE_PRIOR_BITS));
        assert_int_not_equal(x->to, x->from);
        assert_true(x->before.cost > 0);
        assert_true(x->before.cost > x->before.distortion);
        assert_true(x->before.bytes > 100);
        assert_int_equal(x->taken, x->after.cost < x->before.cost);
        taken += x->taken != 0;
        trained += x->steps > 0;
        if (x->steps > 0)
            check_worth(t, x);
        assert_true(x->candidate != TED4_CANDIDATE_ANCHORS || i + 1 == t->search.n_trials);
    }
    assert_true(taken > 0);
    return trained;
}

static void test_decides(void **state)
{
    const ted4_train_options o = dear_options();
    ted4_trainer t;
    size_t weights;

    (void)state;
    begin(&t, &o, NULL);
    ball_train(&t, ted4_model_search_due_step(&t));
    assert_int_equal(t.search.decided, TED4_DECIDED_NOTHING);
    assert_int_equal(t.search.n_trials, 0);
    weights = t.layout.shape.n_netr + t.layout.shape.n_nete;

    /* The weight of a bit must stay fixed. */
    const double charge = ted4_lambda_per_bit(&t);

    assert_int_equal(ted4_trainer_step(&t), 0);
    assert_int_equal(t.search.decided, TED4_DECIDED_MODEL);
    assert_true(t.search.n_trials > 3);
    assert_true(ted4_lambda_per_bit(&t) == charge);
    assert_int_equal(t.layout.head.motion, TED4_MOTION_NONE);
    assert_true(t.layout.shape.n_netr + t.layout.shape.n_nete < weights);
    assert_true(t.net.bits[TED4_WEIGHT_GRID_HEADS] < TED4_WEIGHT_GRID_FULL(TED4_WEIGHT_GRID_HEADS));
    assert_true(t.net.bits[TED4_WEIGHT_GRID_PRIOR] < TED4_WEIGHT_GRID_FULL(TED4_WEIGHT_GRID_PRIOR));
    check_trials(&t);
    ball_train(&t, TOTAL);
    assert_int_equal(t.search.decided, TED4_DECIDED_ALL);
    check_trials(&t);
    ted4_trainer_finish(&t);
}

/* Refines from the given number of bits of the prior. Asserts that each evaluation is recorded and
 * that the best number is kept. Returns whether it is higher than before. */
static int refined(ted4_trainer *t, int bits)
{
    const size_t first = t->search.n_trials;
    ted4_cost before, after;

    t->net.bits[TED4_WEIGHT_GRID_PRIOR] = bits;
    assert_int_equal(ted4_file_cost(t, &before), 0);
    assert_int_equal(ted4_refine_prior_bits(t), 0);
    assert_int_equal(t->search.decided, TED4_DECIDED_BITS);
    assert_true(t->search.n_trials > first);
    assert_true(!t->phase.integer);
    assert_int_equal(ted4_file_cost(t, &after), 0);
    for (size_t i = first; i < t->search.n_trials; i++) {
        const struct ted4_trial *x = &t->search.trial[i];

        assert_int_equal(x->candidate, TED4_CANDIDATE_PRIOR_BITS);
        assert_int_equal(x->from, bits);
        assert_true(x->to > x->from);
        assert_int_equal(x->steps, 0);
        assert_int_equal(x->taken, x->after.cost < x->before.cost);
        bits = (int)(x->taken ? x->to : x->from);
    }
    assert_int_equal(t->net.bits[TED4_WEIGHT_GRID_PRIOR], bits);
    assert_true(bits == t->search.trial[first].from ? after.cost == before.cost
                                                    : after.cost < before.cost);
    return bits > t->search.trial[first].from;
}

/* Bits of the prior that are missing when the integer stage begins are given back. Their number
 * depends on the training: one bit is never enough, and most of the numbers tried here are not. */
static void test_refined(void **state)
{
    const ted4_train_options o = options("capacity=1");
    ted4_trainer t;
    int raised = 0;

    (void)state;
    begin(&t, &o, NULL);
    while (!ted4_integer_due(&t))
        assert_int_equal(ted4_trainer_step(&t), 0);
    assert_int_equal(t.search.decided, TED4_DECIDED_MODEL);
    assert_true(ted4_refine_prior_bits_steps(&t) > 0);
    for (int bits = 1; bits <= 6; bits++)
        raised += refined(&t, bits);
    assert_true(raised > 0);
    ted4_trainer_finish(&t);
}

/* Returns the first trial of motion without training; asserts that there is one. *late: whether the
 * bits of weights were tried before it. */
static const struct ted4_trial *trial_of_motion(const ted4_trainer *t, int *late)
{
    *late = 0;
    for (size_t i = 0; i < t->search.n_trials; i++) {
        const struct ted4_trial *x = &t->search.trial[i];

        if (x->candidate == TED4_CANDIDATE_MOTION && x->steps == 0)
            return x;
        *late |= is_of_bits(x);
    }
    fail_msg("no trial of motion");
    return NULL;
}

/* Weights of a bit from one at which motion goes even for a third of its bytes to one at which it
 * stays. In between it is decided once its weights are coarse. */
static void test_motion_last(void **state)
{
    int n_late = 0;

    (void)state;
    for (double lambda = 0.05; lambda > 0.005; lambda /= 1.4) {
        ted4_train_options o = options("capacity=1");
        ted4_trainer t;
        int late;

        o.lambda = lambda;
        begin(&t, &o, NULL);
        ball_train(&t, ted4_model_search_due_step(&t) + 1);

        const struct ted4_trial *x = trial_of_motion(&t, &late);
        const double added = x->after.distortion - x->before.distortion;
        const double saved = added + x->before.cost - x->after.cost;

        if (!late && x->taken)
            assert_true(saved / 3 >= added);
        n_late += late;
        ted4_trainer_finish(&t);
    }
    assert_in_range(n_late, 1, 6);
}

/* A budget for only a few trials is not spent on the most expensive ones. */
static void test_cheap_first(void **state)
{
    ted4_train_options o = options("capacity=1");
    ted4_trainer t;
    int coarse = 0;

    (void)state;
    ball_set(&o, "capacity_share=0.16");
    begin(&t, &o, NULL);
    ball_train(&t, TOTAL);
    for (size_t i = 0; i < t.search.n_trials; i++) {
        assert_int_not_equal(t.search.trial[i].candidate, TED4_CANDIDATE_OFFSETS);
        coarse += t.search.trial[i].candidate == TED4_CANDIDATE_HEAD_BITS &&
                  t.search.trial[i].taken;
    }
    assert_true(coarse > 0);
    ted4_trainer_finish(&t);
}

/* A model with few candidates, of which the feature comes last but one. How much a smaller feature
 * saves, and how much quality it costs without training, depends on the training; but a trial is
 * trained if the weight of a bit is between a fifth of the ratio of the two and the ratio itself
 * (HOPE in model_search.c), and these rates grow in steps of about 1.5. */
static void test_trained(void **state)
{
    static const char *const few[] = { "motion=0",  "activation=0", "view=0",
                                       "offsets=1", "slices=1",     "octaves=0" };
    static const char *const rates[] = { "lambda=0.0002", "lambda=0.0003", "lambda=0.00045",
                                         "lambda=0.0007", "lambda=0.001",  "lambda=0.0015",
                                         "lambda=0.0022" };
    ted4_train_options o = options("capacity=1");
    ted4_snapshot early = { NULL, 0 };
    ted4_trainer t;
    int trained = 0;

    (void)state;
    for (size_t i = 0; i < sizeof few / sizeof few[0]; i++)
        ball_set(&o, few[i]);
    ball_begin(&t, &o, &scene, NULL);
    ball_train(&t, STAGE1);
    assert_int_equal(ted4_snapshot_take(&t, &early), 0);
    ted4_trainer_finish(&t);
    for (size_t i = 0; i < sizeof rates / sizeof rates[0]; i++) {
        ball_set(&o, rates[i]);
        ball_begin(&t, &o, &scene, NULL);
        assert_int_equal(ted4_snapshot_restore(&t, &early), 0);
        ball_train(&t, ted4_model_search_due_step(&t) + 1);
        trained += check_trials(&t);
        ted4_trainer_finish(&t);
    }
    ted4_snapshot_free(&early);
    assert_true(trained > 0);
}

/* Counts the steps that trials took, including evaluations, as model_search.h does. */
static void test_budget(void **state)
{
    const ted4_train_options o = options("capacity=1");
    ted4_trainer t;
    double spent;
    int taken_trained = 0;

    (void)state;
    begin(&t, &o, NULL);
    ball_train(&t, TOTAL);
    spent = ted4_rd_prune_steps(&t) + 3 * ted4_file_cost_steps(&t);
    for (size_t i = 0; i < t.search.n_trials; i++) {
        const struct ted4_trial *x = &t.search.trial[i];

        if (x->candidate == TED4_CANDIDATE_ANCHORS)
            continue;
        spent += (double)x->steps + ted4_file_cost_steps(&t);
        taken_trained += x->steps > 0 && x->taken;
    }
    spent += taken_trained * ted4_file_cost_steps(&t);
    if (!(spent <= 0.25 * TOTAL + 2 * ted4_file_cost_steps(&t)))
        fail_msg("%g steps, %g allowed", spent, 0.25 * TOTAL);
    ted4_trainer_finish(&t);
}

/* Asserts that weights are on coarse grids and, in the integer stage, equal those of the file. */
static void check_coarse(const ted4_train_options *o, int coarse[TED4_WEIGHT_GRIDS])
{
    ted4_trainer t;
    ted4_scene *s;
    float *again;

    begin(&t, o, NULL);
    ball_train(&t, TOTAL);
    for (size_t i = 0; i < t.search.n_trials; i++)
        if (is_of_bits(&t.search.trial[i]) && t.search.trial[i].taken)
            coarse[t.search.trial[i].candidate - TED4_CANDIDATE_HEAD_BITS] =
                (int)t.search.trial[i].to;
    for (int i = 0; i < TED4_WEIGHT_GRIDS; i++)
        assert_int_equal(coarse[i] > 0 ? coarse[i] : TED4_WEIGHT_GRID_FULL(i), t.net.bits[i]);

    t.opt.capacity = 0; /* or the export would choose spans, which may change pictures */

    const double drawn = ted4_trainer_distortion(&t, t.order.item[0]);

    assert_int_equal(ted4_export_scene(&t, &s), 0);
    assert_true(drawn > 0);
    assert_true(ted4_trainer_distortion(&t, t.order.item[0]) == drawn);
    again = malloc(s->netr.n * sizeof *again);
    assert_non_null(again);
    memcpy(again, s->netr.values, s->netr.n * sizeof *again);
    ted4_weight_grid_scene(&s->shape, t.net.bits, again, s->bank.values);
    assert_memory_equal(again, s->netr.values, s->netr.n * sizeof *again);
    free(again);
    ted4_scene_free(s);
    ted4_trainer_finish(&t);
}

/* At a low rate, the heads' weights are always coarse; at a high rate, so are those of the prior,
 * if trials get as far. */
static void test_coarse(void **state)
{
    const ted4_train_options cheap = options("capacity=1"), dear = dear_options();
    int at_cheap[TED4_WEIGHT_GRIDS] = { 0 }, at_dear[TED4_WEIGHT_GRIDS] = { 0 };

    (void)state;
    check_coarse(&cheap, at_cheap);
    check_coarse(&dear, at_dear);
    assert_true(at_cheap[TED4_WEIGHT_GRID_HEADS] > 0);
    assert_true(at_dear[TED4_WEIGHT_GRID_HEADS] > 0);
    assert_true(at_dear[TED4_WEIGHT_GRID_PRIOR] > 0);
}

static void test_threads(void **state)
{
    const ted4_train_options o = options("capacity=1");
    const ted4_parallel odd[] = { { odd_backwards, NULL }, { odd_threads, NULL } };
    ball_file one;

    (void)state;
    one = whole(&o, NULL);
    for (size_t i = 0; i < 2; i++) {
        ball_file f = whole(&o, &odd[i]);

        ball_check_same(&one, &f);
        free(f.bytes);
    }
    free(one.bytes);
}

/* Resumes from states before, between and after the decisions. */
static void test_resumed(void **state)
{
    const ted4_train_options o = options("capacity=1");
    ted4_snapshot kept[4] = { { NULL, 0 } };
    ted4_trainer t;
    ball_file one;
    int n = 0;

    (void)state;
    begin(&t, &o, NULL);
    ball_train(&t, ted4_model_search_due_step(&t));
    assert_int_equal(ted4_snapshot_take(&t, &kept[n++]), 0);
    assert_int_equal(ted4_trainer_step(&t), 0);
    assert_int_equal(ted4_snapshot_take(&t, &kept[n++]), 0);
    while (!t.phase.integer)
        assert_int_equal(ted4_trainer_step(&t), 0);
    assert_int_equal(ted4_snapshot_take(&t, &kept[n++]), 0);
    assert_int_equal(ted4_trainer_step(&t), 0);
    assert_int_equal(t.search.decided, TED4_DECIDED_ALL);
    assert_int_equal(ted4_snapshot_take(&t, &kept[n++]), 0);

    const size_t trials = t.search.n_trials;

    one = ball_finish(&t);
    ted4_trainer_finish(&t);
    for (int i = 0; i < n; i++) {
        ball_file f;

        ball_begin(&t, &o, &scene, NULL);
        if (ted4_snapshot_restore(&t, &kept[i]) != 0)
            fail_msg("%d: %s", i, t.message.text);
        f = ball_finish(&t);
        assert_int_equal(t.search.n_trials, trials);
        ball_check_same(&one, &f);
        free(f.bytes);
        ted4_trainer_finish(&t);
        ted4_snapshot_free(&kept[i]);
    }
    free(one.bytes);
}

/* A state with decisions is refused by a run of fixed capacity and by one with another lambda. */
static void test_not_mixed(void **state)
{
    const ted4_train_options o = options("capacity=1");
    ted4_train_options other[2] = { options("capacity=0"), o };
    ted4_snapshot kept = { NULL, 0 };
    ted4_trainer t;

    (void)state;
    ball_set(&other[1], "lambda=0.01");
    begin(&t, &o, NULL);
    ball_train(&t, ted4_model_search_due_step(&t) + 1);
    assert_int_equal(ted4_snapshot_take(&t, &kept), 0);
    ted4_trainer_finish(&t);
    for (int i = 0; i < 2; i++) {
        ball_begin(&t, &other[i], &scene, NULL);
        assert_int_equal(ted4_snapshot_restore(&t, &kept), -1);
        ted4_trainer_finish(&t);
    }
    ted4_snapshot_free(&kept);
}

/* With fixed capacity nothing is tried, and the budget of trials has no effect. */
static void test_fixed(void **state)
{
    ted4_train_options o = options("capacity=0"), plain = options("capacity=0");
    ted4_trainer t;
    ball_file a, b;

    (void)state;
    begin(&t, &o, NULL);
    assert_int_equal(ted4_model_search_due_step(&t), UINT64_MAX);
    a = ball_finish(&t);
    assert_int_equal(t.search.n_trials, 0);
    assert_int_equal(t.search.decided, TED4_DECIDED_NOTHING);
    assert_int_equal(t.layout.head.n_offsets, o.offsets);
    assert_int_equal(t.layout.head.feature_dim, o.feature);
    assert_int_equal(t.layout.head.hyper_width, o.hyper_width);
    ted4_trainer_finish(&t);
    ball_set(&plain, "capacity_share=0");
    b = whole(&plain, NULL);
    ball_check_same(&a, &b);
    free(a.bytes);
    free(b.bytes);
}

/* With too few steps, nothing is tried. */
static void test_short(void **state)
{
    ted4_train_options o = options("capacity=1");
    ted4_trainer t;
    ball_file f;

    (void)state;
    ball_set(&o, "stage2=30");
    begin(&t, &o, NULL);
    f = ball_finish(&t);
    assert_int_equal(t.search.n_trials, 0);
    assert_int_equal(t.layout.head.n_offsets, o.offsets);
    free(f.bytes);
    ted4_trainer_finish(&t);
}

/* A higher weight of bits gives a much smaller file. */
static void test_lambda(void **state)
{
    const ted4_train_options cheap = options("capacity=1"), dear = dear_options();
    ball_file low = whole(&cheap, NULL), high = whole(&dear, NULL);

    (void)state;
    assert_true(high.size < low.size * 3 / 4); /* usually half of it */
    free(low.bytes);
    free(high.bytes);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_decides),     cmocka_unit_test(test_refined),
        cmocka_unit_test(test_cheap_first), cmocka_unit_test(test_trained),
        cmocka_unit_test(test_budget),      cmocka_unit_test(test_coarse),
        cmocka_unit_test(test_threads),     cmocka_unit_test(test_resumed),
        cmocka_unit_test(test_not_mixed),   cmocka_unit_test(test_fixed),
        cmocka_unit_test(test_short),       cmocka_unit_test(test_motion_last),
        cmocka_unit_test(test_lambda),
    };

    return cmocka_run_group_tests(tests, set_up, tear_down);
}
