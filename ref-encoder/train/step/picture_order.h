/* picture_order.h - which pictures a step learns from: one, or a batch of one time. Depends on
 * trainer.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_PICTURE_ORDER_H
#define TED4_PICTURE_ORDER_H

#include "train/state/trainer.h"

/* Takes the next pictures, in random order without replacement: one, or with the option batch so
 * many of one time, and announces those that follow. All batches are full, except those of times
 * that have fewer pictures: what is left of a time waits for a later round, each picture in turn,
 * so that all come equally often. item[*n] receives their numbers; it borrows from t->order and is
 * valid until the next call. Returns 0, or -1 with t->message filled. */
int ted4_next_pictures(ted4_trainer *t, const uint32_t **item, size_t *n);

#endif
