/* events.h - the schedule of events between steps: densification, seeding, activation,
 * the changes to stage 2 and to the integer stage. Depends on trainer.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_EVENTS_H
#define TED4_EVENTS_H

#include "train/state/trainer.h"

/* Does what is due before the next step. Returns 0, or -1 with t->message filled. */
int ted4_schedule_event(ted4_trainer *t);
/* Returns whether the integer stage begins with the next step. */
int ted4_integer_due(const ted4_trainer *t);
/* For estimates of time: the shares of stage 1 at which growth begins and seeding takes
 * place, and the share of anchors that is reserved for seeding, 0 if there will be none. */
void ted4_schedule_growth(const ted4_trainer *t, double *from, double *mv_seed_at,
                          double *mv_seed_share);
/* Returns the number of anchors that growth may still add. */
size_t ted4_growth_allowance(const ted4_trainer *t);

#endif
