/* view_exchange.h - sums over the views of a step of which several processes have drawn some each:
 * the same tree, and so the same bits, whoever has drawn what. Depends on exchange.h, view_sums.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_VIEW_EXCHANGE_H
#define TED4_VIEW_EXCHANGE_H

#include "exchange.h"
#include "view_sums.h"

/* Reserves what ted4_view_exchange needs. Returns 0, or -1 if memory ran out. */
int ted4_view_exchange_begin(const ted4_exchange *x, ted4_view_sums *s);
/* Replaces the total of s, over the views that this process has drawn, by that over all n views of
 * the step. Each process adds one part of the arrays: so each sends and receives little more than
 * two arrays, however many they are, and no process waits for another's additions. */
void ted4_view_exchange(ted4_exchange *x, ted4_view_sums *s, size_t n, const ted4_parallel *p);

#endif
