/* rd_prune.c - removes anchors and Gaussians that are not worth their bits: see rd_prune.h. The
 * loss of quality by a removal is known only to first order. So several prices of a bit are tried,
 * each on all anchors at once, and the cost of the whole file decides.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "rd_prune.h"

#include <math.h>
#include <stdlib.h>

#include "file_cost.h"
#include "sensitivity.h"
#include "train/state/visible_blocks.h"
#include "train/monitor/checkpoint.h"
#include "train/step/settle_positions.h"

/* The prices to try, as multiples of lambda per bit. */
static const double prices[] = { 0.125, 0.25, 0.5, 1.0, 2.0, 4.0 };
enum { N_PRICES = (int)(sizeof prices / sizeof prices[0]) };

/* A logit that masks its offset permanently. */
#define OUT (-10.0f)

double ted4_rd_prune_steps(const ted4_trainer *t)
{
    const double steps = ted4_opacity_sensitivity_steps(t) +
                         (1 + N_PRICES) * ted4_file_cost_steps(t);

    return t->layout.head.offset_mask ? ted4_search_afford(t, steps) : 0;
}

/* Worth and bits of all anchors: use is the sensitivity of each Gaussian, [n][K]; bits is
 * [n_blocks][1 + K][32], as in ted4_rate_lanes. */
typedef struct {
    float *use, *bits;
} worth;

static int learn(ted4_trainer *t, worth *w)
{
    const size_t K = t->layout.head.n_offsets;

    w->use = malloc((t->anchors.n * K + 1) * sizeof *w->use);
    w->bits = malloc(t->anchors.n_blocks * (1 + K) * TED4_LANES * sizeof *w->bits);
    if (w->use == NULL || w->bits == NULL)
        return ted4_trainer_fail(t, "no memory to weigh anchors");
    if (ted4_opacity_sensitivity(t, w->use) != 0 || ted4_visible_blocks_fill(t, NULL) != 0)
        return -1;

    const ted4_rate_input in = ted4_visible_blocks_rate(t);

    return ted4_rate_lanes(t->work.rate, &in, t->parallel, t->visible_blocks.steps, w->bits) != 0
               ? ted4_trainer_fail(t, "no memory to weigh anchors")
               : 0;
}

static float *logit(const ted4_trainer *t, size_t i, size_t k)
{
    return ted4_anchor_value(&t->anchors, TED4_ROW_VALUE, i, t->layout.offset_logit + (int)k);
}

static int64_t count_kept(const ted4_trainer *t)
{
    int64_t n = 0;

    for (size_t i = 0; i < t->anchors.n; i++)
        for (size_t k = 0; k < t->layout.head.n_offsets; k++)
            n += ted4_mask_on(*logit(t, i, k)) != 0;
    return n;
}

/* Masks those offsets of one anchor that are not worth their bits at a price, or all of them, if
 * the whole anchor is not. */
static void prune_anchor(ted4_trainer *t, const worth *w, size_t i, double price)
{
    const size_t K = t->layout.head.n_offsets;
    const float *bits = w->bits + i / TED4_LANES * (1 + K) * TED4_LANES + i % TED4_LANES;
    double left = 0, cost = price * (ted4_anchor_bits(t) + (double)bits[0]);

    for (size_t k = 0; k < K; k++) {
        const double use = (double)w->use[i * K + k],
                     paid = price * (double)bits[(1 + k) * TED4_LANES];

        if (!ted4_mask_on(*logit(t, i, k)))
            continue;
        if (use >= 0 && use < paid) {
            *logit(t, i, k) = OUT;
        } else {
            left += use >= 0 ? use : INFINITY; /* keep what no picture showed */
            cost += paid;
        }
    }
    for (size_t k = 0; left < cost && k < K; k++)
        *logit(t, i, k) = OUT;
}

/* Tries one price from *start, unless that would remove nothing or everything. Keeps the result in
 * *best if its cost is the lowest of all prices tried so far. */
static int try_price(ted4_trainer *t, const worth *w, const ted4_snapshot *start, double price,
                     ted4_snapshot *best, struct ted4_trial *x)
{
    ted4_cost c;
    ted4_snapshot mine = { 0 };

    if (ted4_state_restore(t, start) != 0)
        return -1;
    for (size_t i = 0; i < t->anchors.n; i++)
        prune_anchor(t, w, i, price);

    const int64_t kept = count_kept(t);

    if (kept == 0 || kept == x->from)
        return 0;
    if (ted4_state_take(t, &mine) != 0 || ted4_file_cost(t, &c) != 0) {
        ted4_snapshot_free(&mine);
        return -1;
    }
    if (x->to < 0 || c.cost < x->after.cost) {
        x->to = kept;
        x->after = c;
        ted4_snapshot_free(best);
        *best = mine;
    } else {
        ted4_snapshot_free(&mine);
    }
    return 0;
}

int ted4_rd_prune(ted4_trainer *t)
{
    ted4_snapshot start = { 0 }, best = { 0 };
    worth w = { NULL, NULL };
    struct ted4_trial x = { .candidate = TED4_CANDIDATE_ANCHORS, .to = -1 };
    int bad;

    t->search.decided = TED4_DECIDED_ALL;
    if (!(ted4_rd_prune_steps(t) > 0))
        return 0;
    x.from = count_kept(t);
    bad = ted4_state_take(t, &start) != 0 || ted4_file_cost(t, &x.before) != 0 || learn(t, &w) != 0;
    for (int i = 0; !bad && i < N_PRICES; i++)
        bad = try_price(t, &w, &start, prices[i] * ted4_lambda_per_bit(t), &best, &x) != 0;
    x.taken = !bad && x.to >= 0 && x.after.cost < x.before.cost;
    bad = bad || ted4_state_restore(t, x.taken ? &best : &start) != 0;
    if (!bad && x.to >= 0)
        bad = ted4_search_note(t, &x) != 0;
    free(w.use);
    free(w.bits);
    ted4_snapshot_free(&start);
    ted4_snapshot_free(&best);
    return bad ? -1 : 0;
}
