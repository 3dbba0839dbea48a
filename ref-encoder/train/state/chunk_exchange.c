/* chunk_exchange.c - see chunk_exchange.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "chunk_exchange.h"

#include <string.h>

#include "view_exchange.h"

/* The chunks, and how they travel: part by part, each with room for the most chunks that a process
 * has. */
typedef struct {
    const ted4_exchange *x;
    const float *const *chunk;
    size_t n, size, most;
} sum_job;

size_t ted4_chunk_first(const ted4_exchange *x, size_t rank, size_t n)
{
    return n * rank / x->n;
}

/* Returns the first float of the part that a rank adds. */
static size_t part_first(const sum_job *j, size_t rank)
{
    return j->size * rank / j->x->n;
}

/* Packs this rank's chunks for the ranks that add a part of each. */
static void pack_chunks(const sum_job *j, float *to)
{
    const ted4_exchange *x = j->x;
    const size_t from = ted4_chunk_first(x, x->rank, j->n);
    const size_t n = ted4_chunk_first(x, x->rank + 1, j->n) - from;

    for (size_t r = 0; r < x->n; r++) {
        const size_t at = part_first(j, r), own = part_first(j, r + 1) - at;

        memset(to + j->most * at, 0, j->most * own * sizeof *to);
        for (size_t c = 0; c < n; c++)
            memcpy(to + j->most * at + c * own, j->chunk[from + c] + at, own * sizeof *to);
    }
}

/* Adds part[own] of all chunks: received[ranks][most][own]. */
static void add_chunks(const sum_job *j, const float *received, size_t own, int add, float *part)
{
    for (size_t r = 0, done = 0; r < j->x->n; r++)
        for (size_t c = 0; done < ted4_chunk_first(j->x, r + 1, j->n); c++, done++) {
            const float *from = received + (r * j->most + c) * own;

            for (size_t i = 0; i < own; i++)
                part[i] = done == 0 && !add ? from[i] : part[i] + from[i];
        }
}

int ted4_chunk_exchange(ted4_exchange *x, ted4_view_sums *s, const float *const *chunk, size_t n,
                        size_t size, int add, float *to)
{
    const sum_job j = { x, chunk, n, size, (n + x->n - 1) / x->n };
    const size_t own = part_first(&j, x->rank + 1) - part_first(&j, x->rank);
    float *packed = ted4_view_exchange_memory(s, j.most * (size + x->n * own));
    size_t first[TED4_MAX_RANKS + 1];

    if (packed == NULL)
        return -1;
    pack_chunks(&j, packed);
    for (size_t r = 0; r <= x->n; r++)
        first[r] = j.most * part_first(&j, r);
    ted4_exchange_deal(x, packed, first, x->n, packed + j.most * size);
    for (size_t r = 0; r <= x->n; r++)
        first[r] = part_first(&j, r);
    add_chunks(&j, packed + j.most * size, own, add, to + first[x->rank]);
    ted4_exchange_share(x, to, first);
    return 0;
}
