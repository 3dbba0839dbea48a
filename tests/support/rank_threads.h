/* rank_threads.h - the ranks of a training (train/state/exchange.h) as threads, which exchange
 * through common memory.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_RANK_THREADS_H
#define TED4_RANK_THREADS_H

#include <pthread.h>
#include <string.h>

#include "test.h"
#include "train/state/exchange.h"

enum { MOST_RANKS = 6 };

/* What the ranks have in common. */
static struct {
    pthread_barrier_t barrier;
    const void *given[MOST_RANKS];
} ranks;

static inline void rank_gather(void *user, const void *mine, size_t size, void *all)
{
    const ted4_exchange *x = user;

    ranks.given[x->rank] = mine;
    pthread_barrier_wait(&ranks.barrier);
    for (size_t r = 0; r < x->n; r++)
        memcpy((char *)all + r * size, ranks.given[r], size);
    pthread_barrier_wait(&ranks.barrier);
}

static inline void rank_deal(void *user, const float *from, const size_t *first, size_t n_from,
                             float *to)
{
    const ted4_exchange *x = user;
    const size_t at = first[x->rank], own = first[x->rank + 1] - at;

    ranks.given[x->rank] = from;
    pthread_barrier_wait(&ranks.barrier);
    for (size_t r = 0; r < n_from; r++)
        memcpy(to + r * own, (const float *)ranks.given[r] + at, own * sizeof *to);
    pthread_barrier_wait(&ranks.barrier);
}

static inline void rank_share(void *user, float *all, const size_t *first)
{
    const ted4_exchange *x = user;

    ranks.given[x->rank] = all;
    pthread_barrier_wait(&ranks.barrier);
    for (size_t r = 0; r < x->n; r++)
        if (r != x->rank)
            memcpy(all + first[r], (const float *)ranks.given[r] + first[r],
                   (first[r + 1] - first[r]) * sizeof *all);
    pthread_barrier_wait(&ranks.barrier);
}

/* Runs work with each element of process[n], of size bytes, that begins with a ted4_exchange, which
 * is set up; returns when all have ended. */
static inline void rank_run(size_t n, void *process, size_t size, void *(*work)(void *process))
{
    pthread_t thread[MOST_RANKS];

    pthread_barrier_init(&ranks.barrier, NULL, (unsigned)n);
    for (size_t r = 0; r < n; r++) {
        ted4_exchange *x = (ted4_exchange *)((char *)process + r * size);

        *x = (ted4_exchange) { .rank = r,
                               .n = n,
                               .user = x,
                               .gather = rank_gather,
                               .deal = rank_deal,
                               .share = rank_share };
        assert_int_equal(pthread_create(&thread[r], NULL, work, x), 0);
    }
    for (size_t r = 0; r < n; r++)
        pthread_join(thread[r], NULL);
    pthread_barrier_destroy(&ranks.barrier);
}

#endif
