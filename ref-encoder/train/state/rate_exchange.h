/* rate_exchange.h - the rate model by several processes, of which each evaluates some chunks of the
 * chosen blocks: the same bits as by one. Depends on trainer.h, rate/rate.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_RATE_EXCHANGE_H
#define TED4_RATE_EXCHANGE_H

#include "train/rate/rate.h"
#include "trainer.h"

/* Returns what ted4_rate_evaluate needs in its input for t->visible_blocks, their gradients and
 * steps; with t->exchange alone. Valid as long as t. */
ted4_rate_ranks ted4_rate_exchange(ted4_trainer *t);

#endif
