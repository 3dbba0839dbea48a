/* threads.c - see threads.h. Each thread first takes the indices of its own share, which are the
 * same in all jobs with equally many indices. What a thread wrote in one job is therefore still in
 * its cache in the next, and one core mostly writes neighbours in memory. Then it helps the others.
 * A training step has some thirty parallel regions of a fraction of a millisecond each, so idle
 * threads spin for a moment before they sleep, but not for long: an OpenMP team that spins in its
 * barriers made a step five times as long on a machine that had other work.
 * A job ends when its indices are done, not when all threads have taken part: it does not wait for
 * a thread that sleeps or has no processor at the moment. No thread has to wake many others: each
 * one that enters a job wakes two sleepers, which wake two more each.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifdef __linux__
#define _GNU_SOURCE /* sched_getaffinity and CPU_COUNT */
#endif
#include "tool/threads.h"

#include <pthread.h>
#include <sched.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include "tool/thread_start.h"

/* Polls before sleeping, about 20 microseconds; and number of sleepers that each thread wakes. */
enum { SPINS = 1000, WAKES = 2 };

/* Bit of team.inside next to the number of workers: the job may be entered. */
#define OPEN 0x10000u

typedef struct team team;

/* A thread and its share of the indices, in cache lines of its own. Member 0 is the thread that
 * calls run. */
typedef struct {
    _Alignas(64) atomic_size_t next; /* first index not yet handed out */
    size_t end;
    team *team;
    pthread_t thread;
    atomic_int asleep;
    pthread_mutex_t mutex;
    pthread_cond_t woken;
} member;

struct team {
    _Alignas(64) atomic_uint round;  /* jobs begun; the only member that spinning threads read */
    _Alignas(64) atomic_uint inside; /* workers in the job, and OPEN */
    atomic_int waker;                /* first member that has not been checked for sleeping */
    atomic_int waiting;              /* the caller sleeps until the last worker has left */
    pthread_mutex_t mutex;
    pthread_cond_t left;
    void (*body)(void *arg, size_t i);
    void *arg;
    int stop, n; /* n: members */
    member member[TED4_MAX_THREADS];
};

static void relax(void)
{
#if defined(__x86_64__)
    __builtin_ia32_pause();
#elif defined(__aarch64__)
    __asm__ volatile("yield");
#endif
}

/* Runs indices of the share of m, then of the shares after it. */
static void take_indices(team *t, const member *m)
{
    const int first = (int)(m - t->member);

    for (int k = 0; k < t->n; k++) {
        member *owner = &t->member[(first + k) % t->n];
        size_t i;

        /* The load before the increment keeps the cache line shared when no index is left. */
        while (atomic_load_explicit(&owner->next, memory_order_relaxed) < owner->end) {
            i = atomic_fetch_add_explicit(&owner->next, 1, memory_order_relaxed);
            if (i < owner->end)
                t->body(t->arg, i);
        }
    }
}

/* ---- waiting ---- */

static void wake_some(team *t)
{
    for (int woken = 0; woken < WAKES;) {
        const int k = atomic_fetch_add_explicit(&t->waker, 1, memory_order_relaxed);

        if (k >= t->n)
            return;

        member *m = &t->member[k];

        if (!atomic_load(&m->asleep))
            continue;
        pthread_mutex_lock(&m->mutex);
        pthread_cond_signal(&m->woken);
        pthread_mutex_unlock(&m->mutex);
        woken++;
    }
}

/* The accesses to round and asleep are sequentially consistent: either the sleeper sees the new
 * round, or the waking thread sees that it sleeps. */
static void sleep_until_round(team *t, member *m, unsigned last)
{
    pthread_mutex_lock(&m->mutex);
    atomic_store(&m->asleep, 1);
    while (atomic_load(&t->round) == last)
        pthread_cond_wait(&m->woken, &m->mutex);
    atomic_store(&m->asleep, 0);
    pthread_mutex_unlock(&m->mutex);
}

static void wait_for_round(team *t, member *m, unsigned last)
{
    for (int k = 0; k < SPINS; k++) {
        if (atomic_load_explicit(&t->round, memory_order_acquire) != last)
            return;
        relax();
    }
    sleep_until_round(t, m, last);
}

/* Returns 1 if the job is open. It then stays valid until leave, which must be called in any
 * case. */
static int enter(team *t)
{
    return (atomic_fetch_add(&t->inside, 1) & OPEN) != 0;
}

static void leave(team *t)
{
    if (atomic_fetch_sub(&t->inside, 1) == 1 && atomic_load(&t->waiting)) {
        pthread_mutex_lock(&t->mutex);
        pthread_cond_signal(&t->left);
        pthread_mutex_unlock(&t->mutex);
    }
}

static void *work(void *user)
{
    member *m = user;
    team *t = m->team;
    unsigned last = 0;

    for (int stop = 0; !stop;) {
        wait_for_round(t, m, last);

        /* Before entering: a round that begins later, which may be the last one, is then not taken
         * for one that was seen, and the next turn enters it. */
        last = atomic_load_explicit(&t->round, memory_order_acquire);
        if (enter(t)) {
            wake_some(t);
            stop = t->stop;
            if (!stop)
                take_indices(t, m);
        }
        leave(t);
    }
    return NULL;
}

static void begin_round(team *t)
{
    atomic_store_explicit(&t->waker, 1, memory_order_relaxed);
    atomic_fetch_or(&t->inside, OPEN);
    atomic_fetch_add(&t->round, 1);
    wake_some(t);
}

/* Closes the job for new workers, and waits until those inside have done the last indices. */
static void end_round(team *t)
{
    if (atomic_fetch_and(&t->inside, ~OPEN) == OPEN)
        return;
    for (int k = 0; k < SPINS; k++) {
        if (atomic_load_explicit(&t->inside, memory_order_acquire) == 0)
            return;
        relax();
    }
    pthread_mutex_lock(&t->mutex);
    atomic_store(&t->waiting, 1);
    while (atomic_load(&t->inside) != 0)
        pthread_cond_wait(&t->left, &t->mutex);
    atomic_store(&t->waiting, 0);
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

static void forget(member *m)
{
    pthread_cond_destroy(&m->woken);
    pthread_mutex_destroy(&m->mutex);
}

/* Returns 0, or -1 if no more threads can be created. */
static int start(team *t, member *m)
{
    m->team = t;
    pthread_mutex_init(&m->mutex, NULL);
    pthread_cond_init(&m->woken, NULL);
    if (ted4_thread_start(&m->thread, work, m) == 0)
        return 0;
    forget(m);
    return -1;
}

int ted4_threads_allowed(void)
{
    long n;
#ifdef __linux__
    cpu_set_t allowed;

    /* Fails where there are more processors than a set has room for. */
    if (sched_getaffinity(0, sizeof allowed, &allowed) == 0)
        return CPU_COUNT(&allowed);
#endif
    n = sysconf(_SC_NPROCESSORS_ONLN);
    return n > 0 ? (int)n : 1;
}

void ted4_threads_init(ted4_parallel *p, int n_threads)
{
    team *t;

    p->run = run_alone;
    p->user = NULL;
    if (n_threads <= 0)
        n_threads = ted4_threads_allowed();
    if (n_threads > TED4_MAX_THREADS)
        n_threads = TED4_MAX_THREADS;
    if (n_threads <= 1 || (t = aligned_alloc(64, sizeof *t)) == NULL)
        return;
    memset(t, 0, sizeof *t);
    pthread_mutex_init(&t->mutex, NULL);
    pthread_cond_init(&t->left, NULL);
    for (t->n = 1; t->n < n_threads && start(t, &t->member[t->n]) == 0;)
        t->n++;
    p->run = run;
    p->user = t;
}

int ted4_threads_count(const ted4_parallel *p)
{
    return p->user != NULL ? ((const team *)p->user)->n : 1;
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
    for (int i = 1; i < t->n; i++)
        forget(&t->member[i]);
    pthread_cond_destroy(&t->left);
    pthread_mutex_destroy(&t->mutex);
    free(t);
    p->run = run_alone;
    p->user = NULL;
}
