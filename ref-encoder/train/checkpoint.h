/* checkpoint.h - the whole state of a trainer in a file, so that a killed run goes on with the same result.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_CHECKPOINT_H
#define TED4_CHECKPOINT_H

#include "trainer.h"

/* Written to a temporary name, then renamed: the last good checkpoint survives anything. 0, or -1 with t->message. */
int ted4_checkpoint_save(ted4_trainer *t, const char *path);
/* Into a trainer just made by ted4_trainer_init with the same options and scene. 0, or -1 with t->message (other options, other scene,
 * damaged file). */
int ted4_checkpoint_load(ted4_trainer *t, const char *path);

#endif
