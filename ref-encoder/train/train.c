/* train.c - the recipe, from top to bottom. A scene is trained by ted4_gradient_step again and
 * again; at four of these steps something is found out first, which takes as long as many. Source:
 * paper; annex D.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "train.h"

#include "train/search/model_search.h"
#include "train/search/prior_bits.h"
#include "train/search/rd_prune.h"
#include "train/search/static_test.h"
#include "train/step/events.h"
#include "train/step/step.h"

/* What is found out before the next step. */
typedef struct {
    int (*run)(ted4_trainer *t); /* NULL: nothing is */
    ted4_busy busy;
    double steps; /* training steps that it takes at most */
} experiment;

static const experiment nothing = { NULL, TED4_BUSY_TRAINING, 0 };

/* Stage 1: the model learns to draw the pictures, and anchors grow where they are missing. Does the
 * scene need time at all? */
static experiment in_stage1(const ted4_trainer *t)
{
    return ted4_probe_due(t)
               ? (experiment) { ted4_static_test, TED4_BUSY_PROBE, 2.0 * ted4_probe_steps(t) }
               : nothing;
}

/* Stage 2: its bits count as well as the pictures. How much model does the scene need? And, when
 * the integer stage is about to begin: how fine do the weights of the prior have to be? */
static experiment in_stage2(const ted4_trainer *t)
{
    if (t->search.decided == TED4_DECIDED_NOTHING && t->iteration == ted4_model_search_due_step(t))
        return (experiment) { ted4_model_search, TED4_BUSY_TRIALS, ted4_model_search_steps(t) };
    if (t->search.decided == TED4_DECIDED_MODEL && ted4_integer_due(t))
        return (experiment) { ted4_refine_prior_bits, TED4_BUSY_TRIALS,
                              ted4_refine_prior_bits_steps(t) };
    return nothing;
}

/* The integer stage, the end of stage 2: the prior is that of the file and stands still, and the
 * rest goes on learning with it. Which anchors and Gaussians are worth their bits? */
static experiment in_integer_stage(const ted4_trainer *t)
{
    return t->search.decided == TED4_DECIDED_BITS
               ? (experiment) { ted4_rd_prune, TED4_BUSY_TRIALS, ted4_rd_prune_steps(t) }
               : nothing;
}

static experiment next_experiment(const ted4_trainer *t)
{
    return t->phase.integer ? in_integer_stage(t) : t->phase.stage2 ? in_stage2(t) : in_stage1(t);
}

int ted4_trainer_long_step(const ted4_trainer *t)
{
    return next_experiment(t).steps > 0;
}

int ted4_trainer_step(ted4_trainer *t)
{
    const experiment e = next_experiment(t);

    if (e.run != NULL) {
        ted4_trainer_busy(t, e.busy, e.steps);

        const int bad = e.run(t);

        ted4_trainer_busy(t, TED4_BUSY_TRAINING, 0);
        if (bad)
            return -1;
    }
    return ted4_gradient_step(t);
}
