/* view_exchange.h - sums over the views of a step of which several processes have drawn some each:
 * the same tree, and so the same bits, whoever has drawn what. Depends on exchange.h, view_sums.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_VIEW_EXCHANGE_H
#define TED4_VIEW_EXCHANGE_H

#include "exchange.h"
#include "view_sums.h"

/* Replaces the total of s, over the views that this process has drawn, by that over all n views of
 * the step, from float at on: for processes of which each needs all. Each adds one part of the
 * array, so that it sends and receives little more than two arrays, however many they are, and no
 * process waits for another's additions. Returns 0, or -1 if memory ran out. */
int ted4_view_exchange(ted4_exchange *x, ted4_view_sums *s, size_t at, size_t n,
                       const ted4_parallel *p);
/* The same for processes of which each needs one part alone: replaces floats first[rank] to
 * first[rank + 1] behind float at, and leaves the others. first: [ranks + 1]. */
int ted4_view_exchange_part(ted4_exchange *x, ted4_view_sums *s, size_t at, const size_t *first,
                            size_t n, const ted4_parallel *p);
/* Returns memory of size floats for what is received, valid until the next call with this s, or
 * NULL if memory ran out. */
float *ted4_view_exchange_memory(ted4_view_sums *s, size_t size);

#endif
