/* checkpoint.h - saves the whole state of a trainer to a file or to memory, so that an interrupted
 * run continues with the same result, and so that one stage 1 serves many runs of stage 2. A state
 * within stage 1 fits every run with the same options of stage 1 (options.def tells which they
 * are); a later state fits only a run with the same options. Depends on trainer.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_CHECKPOINT_H
#define TED4_CHECKPOINT_H

#include <stdio.h>

#include "train/state/trainer.h"

/* Writes the state to f, and brings it to the disk. Does not write a state that has a value that is
 * not finite. name: that of the file, for messages. Returns 0, or -1 with t->message filled. What f
 * holds then is no checkpoint: a file that is to survive any failure is written under another name
 * first. */
int ted4_checkpoint_write(ted4_trainer *t, FILE *f, const char *name);
/* Writes the state into the file at path, as above. */
int ted4_checkpoint_save(ted4_trainer *t, const char *path);
/* Restores a state into a trainer that ted4_trainer_init made from the same scene and options.
 * Returns 0, or -1 with t->message filled (other options, another scene, a damaged file); t can
 * then only be finished. */
int ted4_checkpoint_load(ted4_trainer *t, const char *path);

/* Take and restore a state in memory. Return 0, or -1 with t->message filled. */
int ted4_snapshot_take(ted4_trainer *t, ted4_snapshot *s);
int ted4_snapshot_restore(ted4_trainer *t, const ted4_snapshot *s);
/* Take and restore a state without the monitor's last good state, which stays unchanged and is
 * itself such a snapshot. Return 0, or -1 with t->message filled. */
int ted4_state_take(ted4_trainer *t, ted4_snapshot *s);
int ted4_state_restore(ted4_trainer *t, const ted4_snapshot *s);

#endif
