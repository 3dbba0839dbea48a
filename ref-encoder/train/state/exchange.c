/* exchange.c - see exchange.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "exchange.h"

#include <string.h>

/* Returns the smallest power of two with which n views are enough for all ranks. */
static size_t views_of_a_rank(const ted4_exchange *x, size_t n)
{
    size_t span = 1;

    while (x == NULL ? span < n : span * x->n < n)
        span *= 2;
    return span;
}

void ted4_exchange_views(const ted4_exchange *x, size_t n, size_t *first, size_t *end)
{
    const size_t span = views_of_a_rank(x, n), from = x == NULL || n == 1 ? 0 : x->rank * span;

    *first = from < n ? from : n;
    *end = from + span < n ? from + span : n;
}

size_t ted4_exchange_drawing(const ted4_exchange *x, size_t n)
{
    const size_t span = views_of_a_rank(x, n);

    return (n + span - 1) / span;
}

void ted4_exchange_gather(ted4_exchange *x, const void *mine, size_t size, void *all)
{
    if (x == NULL) {
        memcpy(all, mine, size);
        return;
    }
    x->gather(x->user, mine, size, all);
    x->bytes += (uint64_t)(x->n - 1) * size;
}

void ted4_exchange_deal(ted4_exchange *x, const float *from, const size_t *first, size_t n_from,
                        float *to)
{
    const size_t own = first[x->rank + 1] - first[x->rank];

    x->deal(x->user, from, first, n_from, to);
    if (x->rank < n_from)
        x->bytes += (uint64_t)(first[x->n] - first[0] - own) * sizeof *from;
}

void ted4_exchange_share(ted4_exchange *x, float *all, const size_t *first)
{
    x->share(x->user, all, first);
    x->bytes += (uint64_t)(x->n - 1) * (first[x->rank + 1] - first[x->rank]) * sizeof *all;
}

int ted4_exchange_first(ted4_exchange *x, int number)
{
    int all[TED4_MAX_RANKS];

    if (x == NULL)
        return number;
    ted4_exchange_gather(x, &number, sizeof number, all);
    for (size_t r = 0; r < x->n; r++)
        if (all[r] != 0)
            return all[r];
    return 0;
}
