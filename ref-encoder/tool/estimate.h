/* estimate.h - how long a training will take: what is left of the schedule, in units of one step
 * with as many anchors as there may be, times what such a unit has taken of late. Knows the trainer
 * by its numbers only.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_ESTIMATE_H
#define TED4_ESTIMATE_H

#include <stdint.h>

/* Schedule, and where training stands in it. */
typedef struct {
    double stage1, stage2; /* steps */
    /* Shares of stage 1: where growth begins, and where multi-view seeding adds anchors. */
    double first_growth, mv_seed_at;
    double mv_seed_share; /* share of anchors that is kept for them; 0: none will come */
    double most_anchors;
    /* Steps of each of the two branches of the time probe; 0: there is none any more. */
    double probe;
    double trials;        /* steps that trials which are still to come are believed to take */
    double step, anchors; /* done; there are */
    /* Of the probe or the trials at hand, so far and in the end, as believed; budget 0: plain
     * training. */
    double spent, budget;
    int probing; /* of the probe, not of trials */
} ted4_work;

typedef struct {
    double clock, units; /* seconds of steps and their work, the latest weighing most */
    double trial_clock, trial_units;
    double when;        /* at the last look; negative: there was none */
    double first, seen; /* clock at the first look; steps since */
    ted4_work last;
} ted4_estimate;

void ted4_estimate_begin(ted4_estimate *e);
/* Training stands here at this time. */
void ted4_estimate_see(ted4_estimate *e, const ted4_work *w, double clock);
/* Training stands elsewhere: what has passed since the last look is not known to be work. */
void ted4_estimate_rewind(ted4_estimate *e, double clock);
/* Seconds until the file is written, from the last look on; negative: not known yet. */
double ted4_estimate_left(const ted4_estimate *e);
/* Enough has been seen to say a first time how long the whole will take. */
int ted4_estimate_ready(const ted4_estimate *e);

#endif
