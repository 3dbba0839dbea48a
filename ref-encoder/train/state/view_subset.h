/* view_subset.h - training pictures that stand for all of them where a few have to judge a model.
 * Pictures at even distances would not do: where cameras have an even number of frames they would
 * show every other frame only, and what is there in the others alone would seem to be of no use.
 * Depends on trainer.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_VIEW_SUBSET_H
#define TED4_VIEW_SUBSET_H

#include "trainer.h"

/* Frames that training pictures show; at least 1. */
size_t ted4_view_subset_frames(const ted4_trainer *t);

/* item[n]: n different training pictures (n at most as many as there are), as numbers in the data
 * set. Every frame comes once before any comes twice, and of a frame its pictures come in turn;
 * which ones is drawn with key. 0, or -1 with t->message. */
int ted4_view_subset_choose(ted4_trainer *t, uint64_t key, size_t n, uint32_t *item);

#endif
