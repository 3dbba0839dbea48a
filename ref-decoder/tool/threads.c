/* threads.c - see threads.h. A training step has some thirty parallel regions of a fraction of a millisecond, so idle threads wait a moment without sleeping,
 * but not for long: an OpenMP team that spins through its barriers made a step five times as long on a machine that had other work.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "tool/threads.h"

#include <pthread.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <unistd.h>

/* Polls before sleeping: about 20 microseconds. */
enum { SPINS = 1000, MAX_THREADS = 256 };

typedef struct {
    pthread_mutex_t mutex;
    pthread_cond_t  start, done;
    atomic_uint     round;              /* jobs begun; odd and even alike */
    atomic_int      busy;               /* workers that have not left the job */
    atomic_size_t   next;               /* first index not yet handed out */
    size_t          n;
    void          (*body)(void *arg, size_t i);
    void           *arg;
    int             stop, n_workers;
    pthread_t       worker[MAX_THREADS];
} team;

static void relax(void)
{
#if defined(__x86_64__)
    __builtin_ia32_pause();
#endif
}

static void take_indices(team *t)
{
    size_t i;

    while ((i = atomic_fetch_add_explicit(&t->next, 1, memory_order_relaxed)) < t->n)
        t->body(t->arg, i);
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
    team    *t = user;
    unsigned round = 0;

    for (;;) {
        wait_for_round(t, round++);
        if (t->stop)
            return NULL;
        take_indices(t);
        if (atomic_fetch_sub_explicit(&t->busy, 1, memory_order_acq_rel) == 1) {
            pthread_mutex_lock(&t->mutex);
            pthread_cond_signal(&t->done);
            pthread_mutex_unlock(&t->mutex);
        }
    }
}

static void begin_round(team *t)
{
    atomic_store_explicit(&t->busy, t->n_workers, memory_order_relaxed);
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

static void run(void *user, size_t n, void (*body)(void *arg, size_t i), void *arg)
{
    team *t = user;

    t->n = n;
    t->body = body;
    t->arg = arg;
    atomic_store_explicit(&t->next, 0, memory_order_relaxed);
    begin_round(t);
    take_indices(t);
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
    if (n_threads > MAX_THREADS)
        n_threads = MAX_THREADS;
    if (n_threads <= 1 || (t = calloc(1, sizeof *t)) == NULL)
        return;
    pthread_mutex_init(&t->mutex, NULL);
    pthread_cond_init(&t->start, NULL);
    pthread_cond_init(&t->done, NULL);
    while (t->n_workers < n_threads - 1 &&
           pthread_create(&t->worker[t->n_workers], NULL, work, t) == 0)
        t->n_workers++;
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
    for (int i = 0; i < t->n_workers; i++)
        pthread_join(t->worker[i], NULL);
    pthread_cond_destroy(&t->done);
    pthread_cond_destroy(&t->start);
    pthread_mutex_destroy(&t->mutex);
    free(t);
    p->run = run_alone;
    p->user = NULL;
}
