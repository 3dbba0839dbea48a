/* target.c - search for the lambda that gives a wanted file size: see training.h. Stage 1 does not
 * depend on lambda, so each trial repeats only stage 2.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <math.h>
#include <stdio.h>

#include "math/elementary.h"
#include "train/monitor/checkpoint.h"
#include "training.h"

/* The search ends with a file that leaves less than this share of the target unused. */
#define NEAR 0.02
enum { MOST_TRIALS = 8 };
/* The size falls at most about as lambda^(-1/GUESS_POWER), and less in a small file that consists
 * mostly of networks and positions. Therefore, until the target lies between two trials, each guess
 * reaches twice as far (in the logarithm) as the one before. NEAREST and FARTHEST bound the factor
 * between two guesses. */
#define GUESS_POWER  4.0
#define NEAREST      2.0
#define FARTHEST     1000.0
#define LEAST_LAMBDA 1e-7
#define MOST_LAMBDA  10.0

/* The last trial on each side of the target: [0] a file that is too large, [1] one that fits. All
 * values are logarithms. have: bit i is set if entry i is filled. */
typedef struct {
    double lambda[2], size[2];
    int have, trials;
} bracket;

/* lambda, size: those of the last trial. */
static double next_lambda(const bracket *b, double target, double lambda, double size)
{
    if (b->have == 3) {
        const double slope = (b->size[1] - b->size[0]) / (b->lambda[1] - b->lambda[0]);
        const double at = (ted4_math_log(target * (1.0 - 0.5 * NEAR)) - b->size[0]) / slope;
        const double span = b->lambda[1] - b->lambda[0];

        return ted4_math_exp(b->lambda[0] + fmin(fmax(at, 0.1 * span), 0.9 * span));
    }
    const double reach = ldexp(GUESS_POWER, b->trials - 1);
    const double away = fabs(ted4_math_log(size / (target * (1.0 - 0.5 * NEAR)))) * reach;
    const double factor = fmin(fmax(ted4_math_exp(fmin(away, 50.0)), NEAREST), FARTHEST);

    return b->have == 1 ? lambda * factor : lambda / factor;
}

static int one_trial(ted4_training *t, const ted4_snapshot *start, double lambda, ted4_coded *c)
{
    const uint64_t end = t->trainer->iteration;

    t->trainer->opt.lambda = lambda;
    if (ted4_snapshot_restore(t->trainer, start) != 0) {
        snprintf(t->why, sizeof t->why, "%s", t->trainer->message.text);
        return -1;
    }
    t->again += end - t->trainer->iteration;
    ted4_run_log_begin_trial(&t->log, t->trainer);
    ted4_training_rewound(t);
    if (ted4_training_go(t, 2) != 0 || ted4_training_code(t, c) != 0)
        return -1;
    ted4_teller_say(t->teller, "lambda %.5g: %zu bytes", lambda, c->size);
    return 0;
}

/* Is a better than b? A file that fits is better than one that does not. Of two that fit, the
 * larger is better; of two that do not, the smaller. */
static int is_better(const ted4_coded *a, const ted4_coded *b, size_t target)
{
    if (b->bytes == NULL || (a->size <= target) != (b->size <= target))
        return b->bytes == NULL || a->size <= target;
    return a->size <= target ? a->size > b->size : a->size < b->size;
}

/* A trial has failed. Returns 0, after a warning, if an earlier one has found a file that fits, and
 * otherwise -1. A signal is obeyed, and one process of several does not know what the others do. */
static int give_up(const ted4_training *t, const ted4_coded *best)
{
    const ted4_exchange *x = t->trainer->exchange;

    if (best->bytes == NULL || best->size > t->request->target_size || t->stopped != 0 ||
        (x != NULL && x->n > 1))
        return -1;
    ted4_teller_error(t->teller, "warning: %s; the file of lambda %.5g is kept", t->why,
                      best->lambda);
    return 0;
}

static int search(ted4_training *t, const ted4_snapshot *start, ted4_coded *best)
{
    const size_t target = t->request->target_size;
    double lambda = t->trainer->opt.lambda;
    bracket b = { 0 };

    for (int i = 0; i < MOST_TRIALS; i++) {
        ted4_coded c;

        lambda = fmin(fmax(lambda, LEAST_LAMBDA), MOST_LAMBDA);
        if (one_trial(t, start, lambda, &c) != 0)
            return give_up(t, best);

        const int fits = c.size <= target;
        const double size = (double)c.size;

        b.lambda[fits] = ted4_math_log(lambda);
        b.size[fits] = ted4_math_log(size);
        b.have |= 1 << fits;
        b.trials++;
        if (is_better(&c, best, target)) {
            ted4_coded_free(best);
            *best = c;
        } else {
            ted4_coded_free(&c);
        }
        if ((fits && size >= (1.0 - NEAR) * (double)target) || (fits && lambda <= LEAST_LAMBDA) ||
            (!fits && lambda >= MOST_LAMBDA))
            break;
        lambda = next_lambda(&b, (double)target, lambda, size);
    }
    return 0;
}

int ted4_training_target(ted4_training *t, ted4_coded *c)
{
    ted4_snapshot start = { 0 };
    int bad;

    c->bytes = NULL;
    if (t->trainer->phase.stage2) {
        snprintf(t->why, sizeof t->why,
                 "%s: inside stage 2; a search for a size begins at the end of stage 1",
                 t->checkpoint);
        return -1;
    }
    if (ted4_training_go(t, 1) != 0)
        return -1;
    t->checkpoint = NULL; /* trials cannot be resumed: a checkpoint lacks the state of the search */
    bad = ted4_snapshot_take(t->trainer, &start) != 0;
    if (bad)
        snprintf(t->why, sizeof t->why, "%s", t->trainer->message.text);
    bad = bad || search(t, &start, c) != 0;
    ted4_snapshot_free(&start);
    if (bad)
        ted4_coded_free(c);
    return bad ? -1 : 0;
}
