/* threads.c - see threads.h. Each thread first takes the indices of its own share, the same ones in every job of as many: what it wrote in one it finds in its cache in
 * the next, and neighbours in memory are mostly written by one core. Then it helps the others.
 * A training step has some thirty parallel regions of a fraction of a millisecond, so idle threads wait a moment without sleeping, but not for long: an OpenMP
 * team that spins through its barriers made a step five times as long on a machine that had other work.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "tool/threads.h"

#include <pthread.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* Polls before sleeping: about 20 microseconds. */
enum { SPINS = 1000 };

typedef struct team team;

/* A thread, and its share of the indices; a cache line of its own. Member 0 is whoever calls run. */
typedef struct {
    _Alignas(64) atomic_size_t next;    /* first index not yet handed out */
    size_t    end;
    team     *team;
    pthread_t thread;
} member;

struct team {
    pthread_mutex_t mutex;
    pthread_cond_t  start, done;
    atomic_uint     round;              /* jobs begun; odd and even alike */
    atomic_int      busy;               /* workers that have not left the job */
    void          (*body)(void *arg, size_t i);
    void           *arg;
    int             stop, n;            /* n: members */
    member          member[TED4_MAX_THREADS];
};

static void relax(void)
{
#if defined(__x86_64__)
    __builtin_ia32_pause();
#endif
}

/* Of the share of m, then of the shares after it. */
static void take_indices(team *t, const member *m)
{
    const int first = (int)(m - t->member);

    for (int k = 0; k < t->n; k++) {
        member *owner = &t->member[(first + k) % t->n];
        size_t  i;

        while ((i = atomic_fetch_add_explicit(&owner->next, 1, memory_order_relaxed)) < owner->end)
            t->body(t->arg, i);
    }
}

static void wait_for_round(team *t, unsigned last)
{
    for (int k = 0; k < SPINS; k++) {
        if (atomic_load_explicit(&t->round, memory_order_acquire) != last)
            return;
        relax();
    }
    pthread_mutex_lock(&t->mutex);
    while (atomic_load_explicit(&t->round, memory_order_acquire) == last)
        pthread_cond_wait(&t->start, &t->mutex);
    pthread_mutex_unlock(&t->mutex);
}

static void *work(void *user)
{
    member  *m = user;
    team    *t = m->team;
    unsigned round = 0;

    for (;;) {
        wait_for_round(t, round++);
        if (t->stop)
            return NULL;
        take_indices(t, m);
        if (atomic_fetch_sub_explicit(&t->busy, 1, memory_order_acq_rel) == 1) {
            pthread_mutex_lock(&t->mutex);
            pthread_cond_signal(&t->done);
            pthread_mutex_unlock(&t->mutex);
        }
    }
}

static void begin_round(team *t)
{
    atomic_store_explicit(&t->busy, t->n - 1, memory_order_relaxed);
    pthread_mutex_lock(&t->mutex);
    atomic_fetch_add_explicit(&t->round, 1, memory_order_release);
    pthread_cond_broadcast(&t->start);
    pthread_mutex_unlock(&t->mutex);
}

static void end_round(team *t)
{
    for (int k = 0; k < SPINS; k++) {
        if (atomic_load_explicit(&t->busy, memory_order_acquire) == 0)
            return;
        relax();
    }
    pthread_mutex_lock(&t->mutex);
    while (atomic_load_explicit(&t->busy, memory_order_acquire) != 0)
        pthread_cond_wait(&t->done, &t->mutex);
    pthread_mutex_unlock(&t->mutex);
}

static size_t share_begin(const team *t, size_t n, int k)
{
    return n / (size_t)t->n * (size_t)k + n % (size_t)t->n * (size_t)k / (size_t)t->n;
}

static void run(void *user, size_t n, void (*body)(void *arg, size_t i), void *arg)
{
    team *t = user;

    t->body = body;
    t->arg = arg;
    for (int k = 0; k < t->n; k++) {
        t->member[k].end = share_begin(t, n, k + 1);
        atomic_store_explicit(&t->member[k].next, share_begin(t, n, k), memory_order_relaxed);
    }
    begin_round(t);
    take_indices(t, &t->member[0]);
    end_round(t);
}

static void run_alone(void *user, size_t n, void (*body)(void *arg, size_t i), void *arg)
{
    (void)user;
    for (size_t i = 0; i < n; i++)
        body(arg, i);
}

void ted4_threads_init(ted4_parallel *p, int n_threads)
{
    team *t;

    p->run = run_alone;
    p->user = NULL;
    if (n_threads <= 0)
        n_threads = (int)sysconf(_SC_NPROCESSORS_ONLN);
    if (n_threads > TED4_MAX_THREADS)
        n_threads = TED4_MAX_THREADS;
    if (n_threads <= 1 || (t = aligned_alloc(64, sizeof *t)) == NULL)
        return;
    memset(t, 0, sizeof *t);
    pthread_mutex_init(&t->mutex, NULL);
    pthread_cond_init(&t->start, NULL);
    pthread_cond_init(&t->done, NULL);
    for (t->n = 1; t->n < n_threads; t->n++) {
        t->member[t->n].team = t;
        if (pthread_create(&t->member[t->n].thread, NULL, work, &t->member[t->n]) != 0)
            break;
    }
    p->run = run;
    p->user = t;
}

void ted4_threads_finish(ted4_parallel *p)
{
    team *t = p->user;

    if (t == NULL)
        return;
    t->stop = 1;
    begin_round(t);
    for (int i = 1; i < t->n; i++)
        pthread_join(t->member[i].thread, NULL);
    pthread_cond_destroy(&t->done);
    pthread_cond_destroy(&t->start);
    pthread_mutex_destroy(&t->mutex);
    free(t);
    p->run = run_alone;
    p->user = NULL;
}
