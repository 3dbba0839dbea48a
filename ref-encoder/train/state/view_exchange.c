/* view_exchange.c - see view_exchange.h. Gradients are summed before they are backpropagated to
 * anchors: behind the generator they would be fewer, but each view would have to go through it
 * alone.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "view_exchange.h"

#include <stdlib.h>
#include <string.h>

/* Floats that all processes exchange at a time, if each needs all: it bounds the memory for what is
 * received. */
enum { AT_A_TIME = 1 << 22 };

float *ted4_view_exchange_memory(ted4_view_sums *s, size_t size)
{
    if (size + 1 > s->received_capacity) {
        free(s->received);
        s->received_capacity = size + size / 4 + 1;
        s->received = malloc(s->received_capacity * sizeof *s->received);
        if (s->received == NULL)
            s->received_capacity = 0;
    }
    return s->received;
}

int ted4_view_exchange_part(ted4_exchange *x, ted4_view_sums *s, size_t at, const size_t *first,
                            size_t n, const ted4_parallel *p)
{
    const size_t own = first[x->rank + 1] - first[x->rank], drawing = ted4_exchange_drawing(x, n);
    float *part = s->node[0] + at, *received = ted4_view_exchange_memory(s, drawing * own);

    if (received == NULL)
        return -1;
    ted4_exchange_deal(x, part, first, drawing, received);
    ted4_view_sums_join(received, own, drawing, p);
    memcpy(part + first[x->rank], received, own * sizeof *part);
    return 0;
}

int ted4_view_exchange(ted4_exchange *x, ted4_view_sums *s, size_t at, size_t n,
                       const ted4_parallel *p)
{
    size_t first[TED4_MAX_RANKS + 1];

    for (; at < s->size; at += AT_A_TIME) {
        const size_t left = s->size - at, size = left < AT_A_TIME ? left : AT_A_TIME;

        for (size_t r = 0; r <= x->n; r++)
            first[r] = size * r / x->n;
        if (ted4_view_exchange_part(x, s, at, first, n, p) != 0)
            return -1;
        ted4_exchange_share(x, s->node[0] + at, first);
    }
    return 0;
}
