/* model_search.h - how much model a scene needs: trials early in stage 2, each a smaller model
 * against the one at hand, by the cost of the file. Depends on trainer.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_CAPACITY_H
#define TED4_CAPACITY_H

#include "train/state/trainer.h"

/* What a model costs: distortion of training pictures plus lambda times the bits of the file, these
 * in units of the values of all anchors as they were before anything was decided, so that a bit
 * weighs the same in every trial. */
typedef struct {
    double cost, distortion;
    double bytes;
} ted4_cost;

/* What may become less, in the order of trials: which Gaussians an anchor has fewer of takes a look
 * at many pictures, so that comes last. */
typedef enum {
    TED4_MOVE_MOTION,
    TED4_MOVE_ACTIVATION,
    TED4_MOVE_HEAD_BITS,
    TED4_MOVE_MOTION_BITS,
    TED4_MOVE_BANK_BITS,
    TED4_MOVE_PRIOR_BITS, /* as ted4_grid */
    TED4_MOVE_HYPER,
    TED4_MOVE_DEFORM,
    TED4_MOVE_AR,
    TED4_MOVE_HEADS,
    TED4_MOVE_BANK,
    TED4_MOVE_FEATURE,
    TED4_MOVE_SLICES,
    TED4_MOVE_OCTAVES,
    TED4_MOVE_VIEW,
    TED4_MOVE_ROWS,
    TED4_MOVE_PHI,
    TED4_MOVE_SCALE,
    TED4_MOVE_OFFSETS,
    TED4_MOVE_ANCHORS,
    TED4_MOVES
} ted4_move;

/* One trial; kept in checkpoints as it stands in memory. */
struct ted4_trial {
    int64_t move, from,
        to; /* what was tried: from so many to so many; more only of bits of the prior's weights */
    int64_t steps; /* training of either side before they were compared; 0: compared at sight */
    int64_t taken; /* 1: the smaller model stays */
    ted4_cost before, after;
};

/* Settles what the model is; t is at the step of ted4_capacity_step. Afterwards it is as many steps
 * further as a trial has, if any was trained. 0, or -1 with t->message. */
int ted4_capacity_decide(ted4_trainer *t);
/* When the integer stage is about to begin, which is when weights become as coarse as they will be
 * in the file: bits of the prior's that it has come to need since are given back. The same results.
 */
int ted4_capacity_refine(ted4_trainer *t);
/* Once the integer stage has begun: anchors and Gaussians go whose bits weigh more than what
 * pictures would miss of them. The same results. */
int ted4_capacity_prune(ted4_trainer *t);
/* The step at which the first is due; UINT64_MAX: never. */
uint64_t ted4_capacity_step(const ted4_trainer *t);

/* What a move is called, e.g. "hidden width of the hyperprior". */
const char *ted4_move_name(ted4_move m);

/* ---- between capacity*.c ---- */

/* Of the model as it is: ends stage 2 on a copy, codes it, and draws some training pictures from
 * it. 0, or -1 with t->message. file_cost.c */
int ted4_capacity_cost(ted4_trainer *t, ted4_cost *c);
/* What a bit of the file weighs. */
double ted4_capacity_charge(const ted4_trainer *t);
/* In training steps: what one such cost takes, what ted4_capacity_usage takes, and what
 * ted4_capacity_refine and ted4_capacity_prune do at most, 0 where the budget is too small for
 * them; what trials may take altogether. */
double ted4_capacity_cost_steps(const ted4_trainer *t);
double ted4_capacity_usage_steps(const ted4_trainer *t);
double ted4_capacity_refine_steps(const ted4_trainer *t);
double ted4_capacity_prune_steps(const ted4_trainer *t);
double ted4_capacity_budget(const ted4_trainer *t);
/* The same number of steps, or 0: too large a part of that budget for one decision. */
double ted4_capacity_afford(const ted4_trainer *t, double steps);
/* Appends to t->trial. 0, or -1 with t->message. */
int ted4_capacity_note(ted4_trainer *t, const struct ted4_trial *x);

/* How much of a move's matter there is now, and the next smaller amount to try, or with bold a much
 * smaller one; -1: there is none. candidates.c */
int ted4_move_now(const ted4_trainer *t, ted4_move m);
int ted4_move_next(const ted4_trainer *t, ted4_move m, int bold);
/* The way back: the next larger number of bits of weights; -1: there is none, or the move has no
 * such way. */
int ted4_move_finer(const ted4_trainer *t, ted4_move m);
/* Makes it so. 0, or -1 with t->message. */
int ted4_move_make(ted4_trainer *t, ted4_move m, int to);

/* What each Gaussian does to training pictures, all of them if there is time: mean over them of |dL
 * / d(log opacity)|: use[n][K]; TED4_UNSEEN where none that was looked at shows it, but others may.
 * At rest the signed sum is near zero, and says nothing. 0, or -1 with t->message. sensitivity.c
 */
#define TED4_UNSEEN (-1.0f)
int ted4_capacity_usage(ted4_trainer *t, float *use);

#endif
