/* test_rd_prune.c - train/search/rd_prune.c: what is removed follows from the rule, written down
 * here once more: at a price of a bit, a Gaussian goes if its sensitivity is less than what its
 * bits cost, and an anchor goes with all its Gaussians if what is left of them is less than the
 * bits of them and of the anchor. One of six prices is taken.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <math.h>
#include <stdlib.h>

#define BALL_FRAMES 12
#include "ball_group.h"
#include "test.h"
#include "train/model/formulas.h"
#include "train/monitor/checkpoint.h"
#include "train/search/file_cost.h"
#include "train/search/rd_prune.h"
#include "train/search/sensitivity.h"
#include "train/state/visible_blocks.h"

enum { STAGE1 = 900, STAGE2 = 300, INTEGER = STAGE1 + 240, PRICES = 6 };

/* Bits of an anchor's position in profile Main and of its motion flag. */
#define ANCHOR_BITS 49.0

static ted4_train_options options;

static int set_up_all(void **state)
{
    options = ball_options();
    ball_set(&options, "stage1=900");
    ball_set(&options, "stage2=300");
    ball_set(&options, "capacity_share=0.25");
    ball_set(&options, "profile=0");
    return set_up(state);
}

static int is_kept(const ted4_trainer *t, size_t i, size_t k)
{
    return ted4_mask_on(*ted4_anchor_value(&t->anchors, TED4_ROW_VALUE, i,
                                           t->layout.offset_logit + (int)k)) != 0;
}

/* What the rule needs of a trainer, for the caller to free: use[n][K], and bits[n_blocks][1 + K]
 * [32]. */
typedef struct {
    float *use, *bits;
} worth;

static worth weigh(ted4_trainer *t)
{
    const size_t K = t->layout.head.n_offsets;
    worth w = { malloc(t->anchors.n * K * sizeof *w.use),
                malloc(t->anchors.n_blocks * (1 + K) * TED4_LANES * sizeof *w.bits) };

    assert_non_null(w.use);
    assert_non_null(w.bits);
    assert_int_equal(ted4_opacity_sensitivity(t, w.use), 0);
    assert_int_equal(ted4_visible_blocks_fill(t, NULL), 0);

    const ted4_rate_input in = ted4_visible_blocks_rate(t);

    assert_int_equal(ted4_rate_lanes(t->work.rate, &in, NULL, t->visible_blocks.steps, w.bits), 0);
    return w;
}

/* Fills kept[K] of anchor i at a price. */
static void keep_at(const ted4_trainer *t, const worth *w, size_t i, double price, int *kept)
{
    const size_t K = t->layout.head.n_offsets;
    const float *bits = w->bits + (i / TED4_LANES * (1 + K)) * TED4_LANES + i % TED4_LANES;
    double gained = 0, paid = price * (ANCHOR_BITS + (double)bits[0]);

    for (size_t k = 0; k < K; k++) {
        const double use = (double)w->use[i * K + k],
                     cost = price * (double)bits[(1 + k) * TED4_LANES];
        const int unseen = w->use[i * K + k] == TED4_UNSEEN;

        kept[k] = is_kept(t, i, k) && (unseen || use >= cost);
        if (kept[k]) {
            gained += unseen ? INFINITY : use;
            paid += cost;
        }
    }
    for (size_t k = 0; gained < paid && k < K; k++)
        kept[k] = 0;
}

/* Number of Gaussians that stay at a price; those of b that do not agree with it are added to
 * *wrong. before: the trainer before, b: after. */
static size_t stay_at(const ted4_trainer *before, const worth *w, double price,
                      const ted4_trainer *b, size_t *wrong)
{
    const size_t K = before->layout.head.n_offsets;
    size_t n = 0;

    for (size_t i = 0; i < before->anchors.n; i++) {
        int kept[TED4_MAX_OFFSETS];

        keep_at(before, w, i, price, kept);
        for (size_t k = 0; k < K; k++) {
            n += (size_t)kept[k];
            *wrong += kept[k] != is_kept(b, i, k);
        }
    }
    return n;
}

/* Moves three anchors to a corner that no picture shows. To be called before stage 2, which sorts
 * positions. */
static void hide_anchors(ted4_trainer *t)
{
    for (size_t i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            *ted4_anchor_value(&t->anchors, TED4_ROW_POSITION, 10 * i, j) = 0.95f +
                                                                            0.015625f * (float)i;
}

/* Opens the masks of all Gaussians of these anchors again, as rate has closed them by now. */
static void open_hidden_anchors(ted4_trainer *t)
{
    size_t hidden = 0;

    for (size_t i = 0; i < t->anchors.n; i++) {
        if (*ted4_anchor_value(&t->anchors, TED4_ROW_POSITION, i, 0) < 0.9f)
            continue;
        hidden++;
        for (int k = 0; k < t->layout.head.n_offsets; k++)
            *ted4_anchor_value(&t->anchors, TED4_ROW_VALUE, i, t->layout.offset_logit + k) = 1.0f;
    }
    assert_true(hidden > 0);
}

/* Number of Gaussians that are kept so far, and that no sampled picture shows. */
static size_t count_unseen(const ted4_trainer *t, const worth *w)
{
    const size_t K = t->layout.head.n_offsets;
    size_t n = 0;

    for (size_t i = 0; i < t->anchors.n * K; i++)
        n += w->use[i] == TED4_UNSEEN && is_kept(t, i / K, i % K);
    return n;
}

/* There are more pictures than are sampled, so that a Gaussian that none of these shows must stay.
 */
static void test_rule(void **state)
{
    static const double prices[PRICES] = { 0.125, 0.25, 0.5, 1, 2, 4 };
    ted4_trainer t, before;
    ted4_snapshot s = { 0 };
    size_t fits = 0;

    (void)state;
    ball_begin(&t, &options, &balls, NULL);
    ball_train(&t, STAGE1);
    hide_anchors(&t);
    ball_train(&t, INTEGER + 1);
    assert_true(t.phase.integer);
    open_hidden_anchors(&t);
    assert_true(ted4_rd_prune_steps(&t) > 0);
    assert_int_equal(ted4_state_take(&t, &s), 0);
    ball_begin(&before, &options, &balls, NULL);
    assert_int_equal(ted4_state_restore(&before, &s), 0);

    worth w = weigh(&before);

    assert_true(count_unseen(&before, &w) > 0);
    if (ted4_rd_prune(&t) != 0)
        fail_msg("%s", t.message.text);
    assert_int_equal(t.search.n_trials, 1);
    assert_int_equal(t.search.trial[0].taken, 1);
    for (int p = 0; p < PRICES; p++) {
        size_t wrong = 0;
        const size_t n = stay_at(&before, &w, prices[p] * ted4_lambda_per_bit(&before), &t, &wrong);

        if (wrong == 0) {
            fits++;
            assert_int_equal(t.search.trial[0].to, n);
            assert_true(n > 0 && t.search.trial[0].from > (int64_t)n);
        }
    }
    assert_true(fits >= 1);
    free(w.use);
    free(w.bits);
    ted4_snapshot_free(&s);
    ted4_trainer_finish(&t);
    ted4_trainer_finish(&before);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_rule),
    };

    return cmocka_run_group_tests(tests, set_up_all, tear_down);
}
