/* trainer_init.h - initialises a trainer before its first step. Depends on trainer.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_TRAINER_INIT_H
#define TED4_TRAINER_INIT_H

#include "train/state/trainer.h"

/* Starts from the initial points. d and p are borrowed until ted4_trainer_finish, which may be
 * called in either case. Returns 0, or -1 with t->message filled. */
int ted4_trainer_init(ted4_trainer *t, const ted4_train_options *o, ted4_dataset *d,
                      const ted4_parallel *p);
/* Starts again from the first step, in the layout of h and without a probe. h must not be part of
 * *t. Returns 0, or -1 with t->message filled. */
int ted4_trainer_restart(ted4_trainer *t, const ted4_header *h);

#endif
