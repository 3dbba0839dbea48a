/* view_exchange.c - see view_exchange.h. Gradients are summed before they are backpropagated to
 * anchors: behind the generator they would be fewer, but each view would have to go through it
 * alone.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "view_exchange.h"

#include <stdlib.h>

/* Floats of the array that all processes exchange at a time: it bounds the memory for what is
 * received. */
enum { AT_A_TIME = 1 << 22 };

int ted4_view_exchange_begin(const ted4_exchange *x, ted4_view_sums *s)
{
    if (x == NULL || x->n == 1 || s->received != NULL)
        return 0;
    /* Each process receives at most one piece from each. */
    s->received = malloc((AT_A_TIME + x->n) * sizeof *s->received);
    return s->received != NULL ? 0 : -1;
}

/* Replaces part[size] of each process by the sum over the n first ones. */
static void exchange_part(ted4_exchange *x, float *part, size_t size, size_t n, float *received,
                          const ted4_parallel *p)
{
    size_t first[TED4_MAX_RANKS + 1];

    for (size_t r = 0; r <= x->n; r++)
        first[r] = size * r / x->n;

    const size_t own = first[x->rank + 1] - first[x->rank];

    ted4_exchange_deal(x, part, first, n, received);
    ted4_view_sums_join(received, own, n, p);
    for (size_t i = 0; i < own; i++)
        part[first[x->rank] + i] = received[i];
    ted4_exchange_share(x, part, first);
}

void ted4_view_exchange(ted4_exchange *x, ted4_view_sums *s, size_t n, const ted4_parallel *p)
{
    float *sum = s->node[0];

    if (x == NULL || x->n == 1)
        return;
    x->steps++;
    for (size_t at = 0; at < s->size; at += AT_A_TIME) {
        const size_t left = s->size - at;

        exchange_part(x, sum + at, left < AT_A_TIME ? left : AT_A_TIME, ted4_exchange_drawing(x, n),
                      s->received, p);
    }
}
