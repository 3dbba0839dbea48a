/* trainer_init.h - a trainer before its first step. Depends on trainer.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_TRAINER_INIT_H
#define TED4_TRAINER_INIT_H

#include "train/state/trainer.h"

/* Start from the initial points. 0, or -1 with t->message. d and p are borrowed until
 * ted4_trainer_finish, which is safe in either case. */
int ted4_trainer_init(ted4_trainer *t, const ted4_train_options *o, ted4_dataset *d,
                      const ted4_parallel *p);
/* The same from the first step on, in the layout of h, and without a probe; h is none of t's own.
 * 0, or -1 with t->message. */
int ted4_trainer_restart(ted4_trainer *t, const ted4_header *h);

#endif
