/* look.c - status line and remaining time of a training run: see ted4_training_look in training.h.
 * This file only reads the trainer's state and does not influence training, except that a signal to
 * end stops it.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <math.h>

#include "stop.h"
#include "tool/clock.h"
#include "train/search/file_cost.h"
#include "train/search/model_search.h"
#include "train/search/prior_bits.h"
#include "train/search/rd_prune.h"
#include "train/search/static_test.h"
#include "train/search/weight_bits.h"
#include "training.h"

/* Expected work of the model search. It tries at least UNTRAINED candidates without training, and
 * trains for at least the share TRAINED of its budget. Some searches use the whole budget, and
 * which ones do is not known in advance, so the share OFTEN of the rest is added. */
#define UNTRAINED 40.0
#define TRAINED   0.08
#define OFTEN     0.25

static double search_steps(const ted4_trainer *t)
{
    const double budget = fmax(ted4_model_search_steps(t), 0.0);
    const double least = fmin(UNTRAINED * ted4_file_cost_steps(t) + TRAINED * budget, budget);

    return least + OFTEN * (budget - least);
}

/* Expected training steps of the trials that have not begun. */
static double trials_left(const ted4_trainer *t)
{
    const double refine = ted4_refine_prior_bits_steps(t), prune = ted4_rd_prune_steps(t);

    if (t->opt.stage2 == 0 || t->search.decided == TED4_DECIDED_ALL)
        return 0;
    if (!t->opt.capacity)
        return ted4_coarsen_weights_steps(t);
    if (t->search.decided == TED4_DECIDED_NOTHING)
        return search_steps(t) + refine + prune;
    return t->search.decided == TED4_DECIDED_MODEL ? refine + prune : prune;
}

/* Expected steps of the trials now under way, in total. */
static double trials_now(const ted4_trainer *t)
{
    return t->search.decided == TED4_DECIDED_MODEL ? search_steps(t) : t->onlooker.budget;
}

/* Steps between two queries of when anchors come; a query has to examine all pictures. */
enum { ASK_EVERY = 500 };

static ted4_work work_of(ted4_training *t)
{
    const ted4_trainer *tr = t->trainer;
    const ted4_onlooker *o = &tr->onlooker;

    if (t->growth.seed_share < 0 || tr->iteration % ASK_EVERY == 0)
        t->growth = ted4_schedule_growth(tr);

    ted4_work w = { .stage1 = tr->opt.stage1,
                    .stage2 = tr->opt.stage2,
                    .first_growth = t->growth.from,
                    .mv_seed_at = t->growth.seed_at,
                    .mv_seed_share = t->growth.seed_share,
                    .most_anchors = tr->opt.max_anchors,
                    .trials = trials_left(tr),
                    .step = (double)(ted4_stage_position(tr) +
                                     (tr->phase.stage2 ? (uint64_t)tr->opt.stage1 : 0)),
                    .anchors = (double)tr->anchors.n,
                    .probing = o->busy == TED4_BUSY_PROBE };

    w.probe = w.probing ? 0.5 * o->budget : ted4_probe_steps(tr);
    w.spent = o->busy != TED4_BUSY_TRAINING ? o->spent : 0;
    w.budget = o->busy == TED4_BUSY_PROBE    ? o->budget
               : o->busy == TED4_BUSY_TRIALS ? trials_now(tr)
                                             : 0;
    return w;
}

/* Prints the estimated duration once, when enough steps were observed. */
static void say_estimate(ted4_training *t, double left)
{
    char time[40];

    if (t->estimated || left < 0 || !ted4_estimate_ready(&t->estimate))
        return;
    t->estimated = 1;
    ted4_teller_time(left, time, sizeof time);
    if (t->request->target_size > 0)
        ted4_teller_say(t->teller, "about %s for the first size tried", time);
    else
        ted4_teller_say(t->teller, "about %s until the file is written", time);
}

int ted4_training_look(void *training)
{
    ted4_training *t = training;
    const ted4_trainer *tr = t->trainer;
    const ted4_onlooker *o = &tr->onlooker;
    ted4_facts *f = &t->facts;
    const double clock = ted4_clock();
    const ted4_work w = work_of(t);

    ted4_estimate_see(&t->estimate, &w, clock);
    f->kind = TED4_TELL_TRAINING;
    f->name[0] = 0;
    f->step = tr->iteration;
    f->total = ted4_trainer_total(tr);
    f->stage = o->busy == TED4_BUSY_PROBE    ? "does the scene need time?"
               : o->busy == TED4_BUSY_TRIALS ? "trials of smaller models"
                                             : ted4_run_log_stage(tr);
    f->share = w.budget > 0 ? w.spent / w.budget : -1;
    f->loss = tr->progress.loss;
    f->anchors = tr->anchors.n;
    f->ms = t->log.ms;
    f->left = ted4_estimate_left(&t->estimate);
    f->when = clock;
    t->log.left = f->left;
    ted4_teller_now(t->teller, f);
    say_estimate(t, f->left);
    return o->busy == TED4_BUSY_TRAINING ? 0 : ted4_training_asked(t);
}

int ted4_training_asked(ted4_training *t)
{
    t->asked = ted4_exchange_first(t->trainer->exchange, ted4_stop_asked());
    return t->asked;
}

void ted4_training_rewound(ted4_training *t)
{
    ted4_estimate_rewind(&t->estimate, ted4_clock());
}
