/* view_subset.h - a subset of the training pictures that represents all of them when models are
 * compared. Pictures at regular intervals would not do: if cameras have an even number of frames,
 * they would show every other frame only, and anything that is visible in the other frames alone
 * would seem to be useless. Depends on trainer.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_VIEW_SUBSET_H
#define TED4_VIEW_SUBSET_H

#include "trainer.h"

/* The number of frames, also of those that are only held out; at least 1. */
size_t ted4_view_subset_frames(const ted4_trainer *t);

/* Fills item[n] with n different training pictures (n at most as many as there are), as numbers in
 * the data set. Every frame comes once before any frame comes twice, and the pictures of a frame
 * take turns; key seeds the random choice. Returns 0, or -1 with t->message. */
int ted4_view_subset_choose(ted4_trainer *t, uint64_t key, size_t n, uint32_t *item);

#endif
