/* events.h - the schedule of events between steps: densification, seeding, activation,
 * the changes to stage 2 and to the integer stage. Depends on trainer.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_EVENTS_H
#define TED4_EVENTS_H

#include "train/state/trainer.h"

/* For estimates of time: when anchors come, and how many. */
typedef struct {
    double from, seed_at; /* shares of stage 1 at which growth begins and seeding takes place */
    double seed_share;    /* share of anchors that is reserved for seeding; 0: there is none */
} ted4_growth;

/* Does what is due before the next step. Returns 0, or -1 with t->message filled. */
int ted4_schedule_event(ted4_trainer *t);
/* Returns whether the integer stage begins with the next step. */
int ted4_integer_due(const ted4_trainer *t);
/* Says when anchors come. Looks at all pictures. */
ted4_growth ted4_schedule_growth(const ted4_trainer *t);
/* Returns the number of anchors that growth may still add. */
size_t ted4_growth_allowance(const ted4_trainer *t);

#endif
