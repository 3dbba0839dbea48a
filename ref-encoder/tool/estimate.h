/* estimate.h - estimates how long a training run will take. The remaining schedule is measured in
 * units of work; one unit is one step with the largest permitted number of anchors. The estimate is
 * the number of remaining units times the recent time per unit. This module does not access the
 * trainer: callers pass the numbers in.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_ESTIMATE_H
#define TED4_ESTIMATE_H

#include <stdint.h>

/* The schedule of a run, and its current state. */
typedef struct {
    double stage1, stage2; /* numbers of steps */
    /* When growth begins, and when seeding adds anchors, as shares of stage 1. */
    double first_growth, mv_seed_at;
    /* Share of most_anchors that is reserved for seeding; 0: it will not take place. */
    double mv_seed_share;
    double most_anchors; /* the largest permitted number of anchors */
    /* Steps of each of the two branches of the time probe; 0: no probe is ahead or under way. */
    double probe;
    double trials;        /* expected steps of the trials that have not begun */
    double step, anchors; /* steps done; current number of anchors */
    /* Steps of the probe or of the trials now under way: done so far, and expected in total.
     * budget is 0 during plain training. */
    double spent, budget;
    int probing; /* 1: spent and budget are those of the probe; 0: those of trials */
} ted4_work;

typedef struct {
    /* Seconds and units of past steps, both with weights that decay with age. */
    double clock, units;
    double trial_clock, trial_units; /* seconds and counted steps of all trials so far */
    double when;                     /* clock at the last observation; negative: there was none */
    double first, seen; /* clock at the first observation; number of later ones with new steps */
    ted4_work last;     /* the last observation */
} ted4_estimate;

void ted4_estimate_begin(ted4_estimate *e);
/* Observes the state of training at a time. clock: seconds, from any fixed origin. */
void ted4_estimate_see(ted4_estimate *e, const ted4_work *w, double clock);
/* Excludes the time since the last observation: training was moved to another step, or interrupted,
 * so that this time may not have been work. */
void ted4_estimate_rewind(ted4_estimate *e, double clock);
/* Returns the seconds from the last observation until the file is written, or a negative number if
 * that is not known yet. */
double ted4_estimate_left(const ted4_estimate *e);
/* Returns 1 once enough steps were observed for a first estimate of the whole duration, else 0. */
int ted4_estimate_ready(const ted4_estimate *e);

#endif
