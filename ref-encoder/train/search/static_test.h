/* static_test.h - does the scene need time? Depends on trainer.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_STATIC_TEST_H
#define TED4_STATIC_TEST_H

#include "train/state/trainer.h"

/* Is the test due before the next step? */
int ted4_probe_due(const ted4_trainer *t);
/* How many steps of each of its two branches the test will have; 0: there will be none. */
int ted4_probe_steps(const ted4_trainer *t);
/* Trains a while with time and without; then it goes on where it was worth it, and else begins
 * again without time, at step 0. 0, or -1 with t->message. */
int ted4_static_test(ted4_trainer *t);

#endif
