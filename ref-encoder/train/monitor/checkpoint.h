/* checkpoint.h - the whole state of a trainer in a file or in memory, so that a killed run goes on
 * with the same result, and so that one stage 1 serves many runs of stage 2. A state within stage 1
 * belongs to every run whose options of stage 1 are the same (options.def tells them apart); a
 * later state to the same options only. Depends on trainer.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_CHECKPOINT_H
#define TED4_CHECKPOINT_H

#include "train/state/trainer.h"

/* Written to a temporary name, then renamed: the last good checkpoint survives anything. A state
 * with a value that is not finite is not written. 0, or -1 with t->message. */
int ted4_checkpoint_save(ted4_trainer *t, const char *path);
/* Into a trainer made by ted4_trainer_init from the same scene and options. 0, or -1 with
 * t->message (other options, other scene, damaged file): t can then only be finished. */
int ted4_checkpoint_load(ted4_trainer *t, const char *path);

/* The same in memory. 0, or -1 with t->message. */
int ted4_snapshot_take(ted4_trainer *t, ted4_snapshot *s);
int ted4_snapshot_restore(ted4_trainer *t, const ted4_snapshot *s);
/* The same without the monitor's last good state, which they leave alone: it is made of such a
 * snapshot. */
int ted4_state_take(ted4_trainer *t, ted4_snapshot *s);
int ted4_state_restore(ted4_trainer *t, const ted4_snapshot *s);

#endif
