/* events.h - what happens at which step beside the step itself: growth, seeding, activation, the
 * change to stage 2 and to the integer model. Depends on trainer.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_EVENTS_H
#define TED4_EVENTS_H

#include "train/state/trainer.h"

/* Does what is due before the next step. 0, or -1 with t->message. */
int ted4_schedule_event(ted4_trainer *t);
/* Does the integer stage begin with the next step? */
int ted4_integer_due(const ted4_trainer *t);
/* Shares of stage 1 at which growth begins and multi-view seeding takes place, and the share of
 * anchors that is kept for these; 0: none will come. For estimates of time. */
void ted4_schedule_growth(const ted4_trainer *t, double *from, double *mv_seed_at,
                          double *mv_seed_share);
/* By how many anchors growth may still add. */
size_t ted4_growth_allowance(const ted4_trainer *t);

#endif
