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
/* The next guess, as a share of the last, after a first trial that left no Gaussian. */
#define RETREAT      (1.0 / 32.0)

/* The last trial on each side of the target: [0] a file that is too large, [1] one that fits. All
 * values are logarithms. have: bit i is set if entry i is filled. empty: of the least lambda that
 * left no Gaussian, infinity if all did. */
typedef struct {
    double lambda[2], size[2], empty;
    int have, trials;
} bracket;

/* The next guess after a trial that gave a file of that size. */
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

/* Returns the guess, or one between the file that is too large and a lambda that leaves nothing. */
static double below_empty(const bracket *b, double lambda)
{
    if (ted4_math_log(lambda) < b->empty)
        return lambda;
    return ted4_math_exp(b->have & 1 ? 0.5 * (b->lambda[0] + b->empty)
                                     : b->empty + ted4_math_log(RETREAT));
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

static int fits(const ted4_training *t, const ted4_coded *c)
{
    return c->bytes != NULL && c->size <= t->request->target_size;
}

/* A trial has failed. Returns 0, after a warning, if an earlier one has found a file that fits, and
 * otherwise -1. A signal is obeyed, and one process of several does not know what the others do. */
static int give_up(const ted4_training *t, const ted4_coded *best)
{
    const ted4_exchange *x = t->trainer->exchange;

    if (!fits(t, best) || t->stopped != 0 || (x != NULL && x->n > 1))
        return -1;
    ted4_teller_error(t->teller, "warning: %s; the file of lambda %.5g is kept", t->why,
                      best->lambda);
    return 0;
}

/* Adds a trial to the bracket, and its file to the best one. Returns the next lambda, or 0 if the
 * search ends here. */
static double learn(bracket *b, size_t target, ted4_coded *c, ted4_coded *best)
{
    const int side = c->size <= target;
    const double size = (double)c->size, lambda = c->lambda;

    b->lambda[side] = ted4_math_log(lambda);
    b->size[side] = ted4_math_log(size);
    b->have |= 1 << side;
    b->trials++;
    if (is_better(c, best, target)) {
        ted4_coded_free(best);
        *best = *c;
    } else {
        ted4_coded_free(c);
    }
    if (side ? size >= (1.0 - NEAR) * (double)target || lambda <= LEAST_LAMBDA
             : lambda >= MOST_LAMBDA)
        return 0;
    return next_lambda(b, (double)target, lambda, size);
}

/* A lambda that leaves no Gaussian bounds the search, for all processes alike; any other failure
 * ends it. */
static int search(ted4_training *t, const ted4_snapshot *start, ted4_coded *best)
{
    bracket b = { .empty = INFINITY };
    double lambda = t->trainer->opt.lambda;

    for (int i = 0; i < MOST_TRIALS && lambda > 0; i++) {
        ted4_coded c;

        lambda = below_empty(&b, fmin(fmax(lambda, LEAST_LAMBDA), MOST_LAMBDA));
        if (one_trial(t, start, lambda, &c) == 0) {
            lambda = learn(&b, t->request->target_size, &c, best);
        } else if (t->trainer->is_empty && t->stopped == 0) {
            b.empty = ted4_math_log(lambda);
            ted4_teller_say(t->teller, "lambda %.5g: no Gaussian is left", lambda);
        } else {
            return give_up(t, best);
        }
    }
    if (best->bytes == NULL)
        snprintf(t->why, sizeof t->why, "%s", t->trainer->message.text);
    return best->bytes == NULL ? -1 : 0;
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
    if (bad && !(t->stopped != 0 && fits(t, c)))
        ted4_coded_free(c);
    return bad ? -1 : 0;
}
