/* train.c - the training recipe, from top to bottom. A scene is trained by calling
 * ted4_gradient_step again and again. Before four of these steps, an experiment answers a question
 * about the model first, which takes as long as many steps. Source: paper; annex D.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "train.h"

#include "train/search/model_search.h"
#include "train/search/prior_bits.h"
#include "train/search/rd_prune.h"
#include "train/search/static_test.h"
#include "train/search/weight_bits.h"
#include "train/step/events.h"
#include "train/step/step.h"

/* The experiment that precedes the next step. */
typedef struct {
    int (*run)(ted4_trainer *t); /* NULL: none */
    ted4_busy busy;
    double steps; /* upper bound of its duration, in training steps */
} experiment;

static const experiment nothing = { NULL, TED4_BUSY_TRAINING, 0 };

/* Stage 1: the model learns to render the pictures, and anchors grow where they are missing. The
 * question: does the scene need time at all? */
static experiment in_stage1(const ted4_trainer *t)
{
    return ted4_probe_due(t)
               ? (experiment) { ted4_static_test, TED4_BUSY_PROBE, 2.0 * ted4_probe_steps(t) }
               : nothing;
}

/* Stage 2: the loss includes the rate. The questions: how large a model does the scene need? And,
 * just before the integer stage begins: how fine must the prior's weights be? */
static experiment in_stage2(const ted4_trainer *t)
{
    if (t->search.decided == TED4_DECIDED_NOTHING && t->iteration == ted4_model_search_due_step(t))
        return (experiment) { ted4_model_search, TED4_BUSY_TRIALS, ted4_model_search_steps(t) };
    if (t->search.decided == TED4_DECIDED_MODEL && ted4_integer_due(t))
        return (experiment) { ted4_refine_prior_bits, TED4_BUSY_TRIALS,
                              ted4_refine_prior_bits_steps(t) };
    if (t->search.decided == TED4_DECIDED_NOTHING && ted4_integer_due(t) &&
        ted4_coarsen_weights_steps(t) > 0)
        return (experiment) { ted4_coarsen_weights, TED4_BUSY_TRIALS,
                              ted4_coarsen_weights_steps(t) };
    return nothing;
}

/* The integer stage at the end of stage 2: the prior is the one of the file and no longer changes,
 * while the other parameters go on learning with it. The question: which anchors and Gaussians are
 * worth their bits? */
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
