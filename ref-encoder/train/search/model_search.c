/* model_search.c - chooses the trials, and the smaller model to take: see model_search.h. First,
 * every candidate is tried untrained, as far as it lowers the cost without any training. The rest
 * of the budget is spent on training: the candidates that promise the lowest cost are trained
 * first, and compared with the current model after the same training.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "model_search.h"

#include <math.h>
#include <stdlib.h>

#include "branch.h"
#include "candidates.h"
#include "file_cost.h"
#include "prior_bits.h"
#include "rd_prune.h"
#include "sensitivity.h"
#include "train/monitor/checkpoint.h"

/* Share of stage 2 before the search: by then, values have become cheaper, and the prior fits them.
 * Measured on three small scenes: with 0.5, costs differ by up to 1 %, in both directions. */
#define DECIDE_AT   0.15
/* SIGHT_SHARE: share of the budget for untrained trials. TRIALS: number of trained trials that the
 * budget would pay for if there were no untrained ones. FEWEST_STEPS: minimum steps of a trained
 * trial. */
#define SIGHT_SHARE 0.7
enum { TRIALS = 16, FEWEST_STEPS = 50 };
/* HOPE: the largest share of the distortion added by an untrained candidate that training can be
 * expected to recover. */
#define HOPE       0.8
/* COARSE: the share of their bytes that weights keep on the grids of later trials: of 24 bits, most
 * keep 6 to 8. */
#define COARSE     (1.0 / 3.0)
/* LEAST_GAIN: a candidate that would not lower the cost by this share, even if training recovers as
 * much as can be expected, is not worth training. */
#define LEAST_GAIN 5e-4

typedef struct {
    ted4_trainer *t;
    ted4_snapshot now, trained; /* the current model: before training, after it */
    ted4_cost now_cost, trained_cost;
    struct ted4_trial *trial; /* owned */
    size_t n_trials;
    double budget, spent; /* training steps */
    int steps;            /* of a trained trial */
    struct {
        int from, to;
        ted4_cost cost, base;
    } untrained[TED4_CANDIDATES]; /* the next trial of each candidate, with its untrained cost, and
                                     that of the model it was applied to; to is -1 if there is
                                     none */
    int waits[TED4_CANDIDATES];   /* 1: decided after the others */
} search;

double ted4_model_search_steps(const ted4_trainer *t)
{
    return ted4_search_budget(t) - ted4_refine_prior_bits_steps(t) - ted4_rd_prune_steps(t);
}

/* Returns the steps of a trained trial, or 0 if they would be too few to tell anything. */
static int trial_steps(const ted4_trainer *t)
{
    const double budget = ted4_model_search_steps(t);
    const double steps_left = (1.0 - t->opt.integer_share - DECIDE_AT) * (double)t->opt.stage2 -
                              1.0;
    const double n = fmin(fmax(budget / TRIALS, FEWEST_STEPS), steps_left);

    return n >= FEWEST_STEPS && n <= budget ? (int)n : 0;
}

uint64_t ted4_model_search_due_step(const ted4_trainer *t)
{
    return t->opt.capacity && t->opt.stage2 > 0
               ? (uint64_t)t->opt.stage1 + (uint64_t)(DECIDE_AT * (double)t->opt.stage2)
               : UINT64_MAX;
}

static int note(search *s, ted4_candidate m, int from, int to, int taken, int steps,
                const ted4_cost *before, const ted4_cost *after)
{
    struct ted4_trial *more = realloc(s->trial, (s->n_trials + 1) * sizeof *more);

    if (more == NULL)
        return ted4_trainer_fail(s->t, "no memory to note a trial");
    s->trial = more;
    more[s->n_trials++] = (struct ted4_trial) { m, from, to, steps, taken, *before, *after };
    return 0;
}

static void swap(ted4_snapshot *a, ted4_snapshot *b)
{
    const ted4_snapshot x = *a;

    *a = *b;
    *b = x;
}

static int measure(search *s, ted4_cost *c)
{
    s->spent += ted4_file_cost_steps(s->t);
    return ted4_file_cost(s->t, c);
}

/* Applies a candidate to the current model, and measures the cost without training. Returns 0, 1 if
 * there is no such candidate, or -1 on failure. */
static int look(search *s, ted4_candidate m, int bold)
{
    s->untrained[m].to = -1;
    if (ted4_state_restore(s->t, &s->now) != 0)
        return -1;

    const int to = ted4_candidate_next(s->t, m, bold);

    if (to < 0)
        return 1;
    s->untrained[m].from = ted4_candidate_now(s->t, m);
    s->spent += m == TED4_CANDIDATE_OFFSETS ? ted4_opacity_sensitivity_steps(s->t) : 0.0;
    if (ted4_candidate_make(s->t, m, to) != 0 || measure(s, &s->untrained[m].cost) != 0)
        return -1;
    s->untrained[m].base = s->now_cost;
    s->untrained[m].to = to;
    return 0;
}

/* Makes the result of the last look the current model if it costs less. Afterwards the trainer
 * holds the current model. Returns 1 if it was taken, 0 if not, or -1 on failure. */
static int take_if_cheaper(search *s, ted4_candidate m)
{
    const ted4_cost before = s->now_cost, after = s->untrained[m].cost;
    const int taken = after.cost < before.cost, to = s->untrained[m].to;
    ted4_snapshot smaller = { 0 };
    int bad = (taken ? ted4_state_take(s->t, &smaller) : ted4_state_restore(s->t, &s->now)) != 0;

    bad = bad || note(s, m, s->untrained[m].from, to, taken, 0, &before, &after) != 0;
    if (!bad && taken) {
        swap(&s->now, &smaller);
        s->now_cost = after;
        s->untrained[m].to = -1;
    }
    ted4_snapshot_free(&smaller);
    return bad ? -1 : taken;
}

/* Whether bold steps make sense. Halving the inputs of all Gaussians is never free. Weights with
 * few bits may cost less than with all bits, but more than with some number in between, which a
 * bold step would skip. */
static int may_be_bold(ted4_candidate m)
{
    return m != TED4_CANDIDATE_HEADS && m != TED4_CANDIDATE_FEATURE &&
           m != TED4_CANDIDATE_OFFSETS && m != TED4_CANDIDATE_HEAD_BITS &&
           m != TED4_CANDIDATE_MOTION_BITS;
}

/* Whether the candidate of the last look has to wait. While all weights have all their bits, motion
 * and activation cost more than they will: whether one of them goes is decided at once if that is
 * clear even so, otherwise after all other candidates. */
static int has_to_wait(const search *s, ted4_candidate m)
{
    const ted4_cost *with = &s->now_cost, *without = &s->untrained[m].cost;
    const double added = without->distortion - with->distortion;
    const double saved = added + with->cost - without->cost;

    return (m == TED4_CANDIDATE_MOTION || m == TED4_CANDIDATE_ACTIVATION) && !s->waits[m] &&
           saved > added && COARSE * saved < added;
}

/* Applies a candidate repeatedly, in bold steps and then in small ones, while each step lowers the
 * untrained cost. */
static int descend(search *s, ted4_candidate m)
{
    int bold = may_be_bold(m);

    while (s->waits[m] || s->spent < SIGHT_SHARE * s->budget) {
        const int bolder = ted4_candidate_next(s->t, m, 1), next = ted4_candidate_next(s->t, m, 0);

        bold = bold && bolder != next;

        const int seen = look(s, m, bold);

        if (seen == 0 && has_to_wait(s, m)) {
            s->waits[m] = 1;
            return 0;
        }
        const int taken = seen == 0 ? take_if_cheaper(s, m) : seen;

        if (taken < 0)
            return -1;
        if (seen > 0 || (taken == 0 && !bold))
            break;
        bold = bold && taken;
    }
    return 0;
}

/* Trains from the current state of s->t. If the monitor gives up the model, sets *lost instead of
 * failing. */
static int train(search *s, ted4_snapshot *after, ted4_cost *cost, int *lost)
{
    double loss;

    *lost = 0;
    if (ted4_branch_run(s->t, s->steps, &loss) != 0) {
        *lost = s->t->monitor.found;
        s->t->monitor.found = 0;
        return *lost ? 0 : -1;
    }
    return ted4_state_take(s->t, after) != 0 || measure(s, cost) != 0;
}

/* Returns the most promising candidate, or TED4_CANDIDATES if none is worth training. The current
 * model has changed since candidates were looked at, so that costs are compared as ratios. */
static ted4_candidate choose(const search *s)
{
    ted4_candidate best = TED4_CANDIDATES;
    double least = 1.0 - LEAST_GAIN;

    for (int m = 0; m < TED4_CANDIDATES; m++) {
        const ted4_cost *c = &s->untrained[m].cost, *base = &s->untrained[m].base;
        const double hoped = c->cost - HOPE * fmax(c->distortion - base->distortion, 0.0);

        if (s->untrained[m].to >= 0 && hoped < least * base->cost) {
            least = hoped / base->cost;
            best = (ted4_candidate)m;
        }
    }
    return best;
}

/* Does one trained trial. */
static int try_candidate(search *s, ted4_candidate m)
{
    ted4_snapshot start = { 0 }, end = { 0 };
    const int to = s->untrained[m].to;
    const ted4_cost before = s->trained_cost;
    ted4_cost after = { 0 };
    int lost = 0, bad = ted4_state_restore(s->t, &s->now) != 0;
    const int from = ted4_candidate_now(s->t, m);

    s->untrained[m].to = -1;
    if (!bad && to >= from) /* what was taken meanwhile has removed the part, or made it smaller */
        return 0;
    bad = bad || ted4_candidate_make(s->t, m, to) != 0 || ted4_state_take(s->t, &start) != 0 ||
          train(s, &end, &after, &lost) != 0;
    s->spent += s->steps;

    const int taken = !bad && !lost && after.cost < before.cost;

    if (lost)
        after = before; /* nothing is known of it */
    bad = bad || note(s, m, from, to, taken, s->steps, &before, &after) != 0;
    if (!bad && taken) {
        swap(&s->now, &start);
        swap(&s->trained, &end);
        s->now_cost = s->untrained[m].cost;
        s->trained_cost = after;
        bad = look(s, m, 0) < 0;
    }
    ted4_snapshot_free(&start);
    ted4_snapshot_free(&end);
    return bad ? -1 : 0;
}

static int search_all(search *s)
{
    int lost, bad = ted4_state_take(s->t, &s->now) != 0 || measure(s, &s->now_cost) != 0;

    for (int m = 0; m < TED4_CANDIDATES; m++)
        s->untrained[m].to = -1;
    for (int m = 0; !bad && m < TED4_CANDIDATES; m++)
        bad = ted4_state_restore(s->t, &s->now) != 0 || descend(s, (ted4_candidate)m) != 0;
    for (int m = 0; !bad && m < TED4_CANDIDATES; m++)
        bad = s->waits[m] &&
              (ted4_state_restore(s->t, &s->now) != 0 || descend(s, (ted4_candidate)m) != 0);
    bad = bad || ted4_state_restore(s->t, &s->now) != 0 ||
          train(s, &s->trained, &s->trained_cost, &lost) != 0;
    if (!bad && lost)
        return ted4_trainer_fail(s->t, "the model that trials chose could not be trained");
    while (!bad && s->spent + s->steps <= s->budget) {
        const ted4_candidate m = choose(s);

        if (m == TED4_CANDIDATES)
            break;
        bad = try_candidate(s, m) != 0;
    }
    return bad || ted4_state_restore(s->t, &s->trained) != 0 ? -1 : 0;
}

int ted4_model_search(ted4_trainer *t)
{
    search s = { .t = t, .budget = ted4_model_search_steps(t), .steps = trial_steps(t) };
    int bad = 0;

    t->search.decided = TED4_DECIDED_MODEL; /* set in all later snapshots, so that trials do
                                               not search in turn */
    if (s.steps > 0)
        bad = search_all(&s) != 0;
    ted4_snapshot_free(&s.now);
    ted4_snapshot_free(&s.trained);
    for (size_t i = 0; !bad && i < s.n_trials; i++)
        bad = ted4_search_note(t, &s.trial[i]) != 0;
    free(s.trial);
    return bad ? -1 : 0;
}
