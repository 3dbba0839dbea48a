/* dropout.h - dropout of anchors in stage 1, against overfitting: each step leaves out a random
 * share of the groups of anchors, so that no Gaussian can rely on its neighbours to make up for it.
 * Groups, and not single anchors, because neighbours stand in the same block and would make up for
 * one. Depends on trainer.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_DROPOUT_H
#define TED4_DROPOUT_H

#include "trainer.h"

/* The share of groups that the coming training step leaves out, 0 .. 1: grows in proportion to the
 * steps of stage 1, towards ted4_dropout_most. 0 in stage 2. */
double ted4_dropout_share(const ted4_trainer *t);
/* The share at the end of stage 1: the option dropout where few cameras see a time, less where more
 * do, and 0 with many. */
double ted4_dropout_most(const ted4_trainer *t);
/* Leaves that share out of t->visible_blocks, which ted4_visible_blocks_fill has just filled. Which
 * groups, depends on the seed and on the number of the step alone. */
void ted4_dropout(ted4_trainer *t);

#endif
