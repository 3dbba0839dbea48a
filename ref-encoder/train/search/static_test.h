/* static_test.h - the static test (probe): finds out whether the scene needs time. Depends on
 * trainer.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_STATIC_TEST_H
#define TED4_STATIC_TEST_H

#include "train/state/trainer.h"

/* Returns whether the test is due before the next step. */
int ted4_probe_due(const ted4_trainer *t);
/* Returns the number of steps in each of the test's two branches, or 0 if there will be no test. */
int ted4_probe_steps(const ted4_trainer *t);
/* Trains for a while with time, and for as long without. If time was worth it, continues from the
 * end of the first branch, otherwise starts again without time, at step 0. Returns 0, or -1 with
 * t->message filled. */
int ted4_static_test(ted4_trainer *t);

#endif
