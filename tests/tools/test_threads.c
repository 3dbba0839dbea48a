/* test_threads.c - tool/threads.c: every index runs exactly once, for any numbers of threads and
 * indices and however uneven the work; sleeping threads wake up, and all end with their pool.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifdef __linux__
#define _GNU_SOURCE /* sched_setaffinity */
#endif
#include <sched.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "test.h"
#include "tool/thread_start.h"
#include "tool/threads.h"

enum { MOST = 3000, THREADS = 9 };

typedef struct {
    atomic_uint taken[MOST];
    size_t slow;        /* this index takes as long as all others together */
    atomic_uint others; /* indices done, without slow */
    size_t n;
} counts;

static void take(void *arg, size_t i)
{
    counts *c = arg;

    atomic_fetch_add(&c->taken[i], 1);
    if (i != c->slow)
        atomic_fetch_add(&c->others, 1);
}

static void check_once(const ted4_parallel *p, counts *c, size_t n)
{
    memset(c, 0, sizeof *c);
    c->n = n;
    c->slow = n;
    ted4_parallel_for(p, n, take, c);
    for (size_t i = 0; i < MOST; i++)
        assert_int_equal(atomic_load(&c->taken[i]), i < n);
}

static void test_once(void **state)
{
    static const size_t n[] = { 0, 1, 2, 3, 5, 8, 9, 10, 17, 100, 1001, MOST };
    counts *c = malloc(sizeof *c);

    (void)state;
    for (int threads = 1; threads <= THREADS; threads++) {
        ted4_parallel p;

        ted4_threads_init(&p, threads);
        for (int round = 0; round < 40; round++)
            for (size_t k = 0; k < sizeof n / sizeof n[0]; k++)
                check_once(&p, c, n[k]);
        ted4_threads_finish(&p);
    }
    free(c);
}

/* The first index, in a share of 1,500, waits until all others are done: other threads must take
 * the rest of its share. */
static void wait_for_others(void *arg, size_t i)
{
    counts *c = arg;

    take(arg, i);
    while (i == c->slow && atomic_load(&c->others) < c->n - 1)
        ;
}

static void test_helped(void **state)
{
    counts *c = calloc(1, sizeof *c);
    ted4_parallel p;

    (void)state;
    ted4_threads_init(&p, 2);
    if (p.user == NULL) {
        print_message("skipped: no second thread here\n");
        skip();
    }
    alarm(60); /* without help it would wait forever */
    for (int end = 0; end < 2; end++) {
        memset(c, 0, sizeof *c);
        c->n = MOST;
        c->slow = end ? MOST / 2 : 0;
        ted4_parallel_for(&p, MOST, wait_for_others, c);
        assert_int_equal(atomic_load(&c->others), MOST - 1);
    }
    alarm(0);
    ted4_threads_finish(&p);
    free(c);
}

/* Waits until as many threads as there are indices have arrived. */
static void meet(void *arg, size_t i)
{
    counts *c = arg;

    take(arg, i);
    while (atomic_load(&c->others) < c->n)
        sched_yield();
}

/* All threads that have gone to sleep wake up for a job that waits until each of them has
 * arrived. */
static void test_woken(void **state)
{
    const struct timespec pause = { 0, 2000000 };
    counts *c = calloc(1, sizeof *c);

    (void)state;
    alarm(60);
    for (int threads = 2; threads <= THREADS; threads++) {
        ted4_parallel p;

        ted4_threads_init(&p, threads);
        if (p.user == NULL) {
            print_message("skipped: no second thread here\n");
            skip();
        }
        for (int round = 0; round < 20; round++) {
            memset(c, 0, sizeof *c);
            c->n = (size_t)threads;
            c->slow = c->n;
            nanosleep(&pause, NULL);
            ted4_parallel_for(&p, c->n, meet, c);
            assert_int_equal(atomic_load(&c->others), threads);
        }
        ted4_threads_finish(&p);
    }
    alarm(0);
    free(c);
}

/* Threads that come too late for the only job of their pool meet its end, sooner or later: each of
 * them must see it, or finish waits for it forever. */
static void test_finished(void **state)
{
    enum { POOLS = 500, PAUSES = 50, PAUSE = 6000 };
    counts *c = calloc(1, sizeof *c);

    (void)state;
    alarm(60);
    for (int k = 0; k < POOLS; k++) {
        const struct timespec pause = { 0, k % PAUSES * PAUSE };
        ted4_parallel p;

        ted4_threads_init(&p, 2 + k % (THREADS - 1));
        ted4_parallel_for(&p, 2, take, c);
        nanosleep(&pause, NULL);
        ted4_threads_finish(&p);
    }
    assert_int_equal(atomic_load(&c->taken[1]), POOLS);
    alarm(0);
    free(c);
}

/* Without a number, a process that is kept to one processor gets no second thread. */
static void test_allowed(void **state)
{
    (void)state;
    assert_true(ted4_threads_allowed() >= 1);
#ifdef __linux__
    cpu_set_t before, one;
    ted4_parallel p;
    int first = 0;

    if (sched_getaffinity(0, sizeof before, &before) != 0) {
        print_message("skipped: the system does not tell this process its cores\n");
        skip();
    }
    while (!CPU_ISSET(first, &before))
        first++;
    CPU_ZERO(&one);
    CPU_SET(first, &one);
    assert_int_equal(sched_setaffinity(0, sizeof one, &one), 0);
    assert_int_equal(ted4_threads_allowed(), 1);
    ted4_threads_init(&p, 0);
    assert_int_equal(ted4_threads_count(&p), 1);
    ted4_threads_finish(&p);
    assert_int_equal(sched_setaffinity(0, sizeof before, &before), 0);
#endif
}

/* Where a thread of the system's has less, ours has at least what it is promised; the system may
 * take some of it. */
static void *fill_stack(void *arg)
{
    volatile unsigned char bytes[TED4_THREAD_STACK / 8 * 7];

    for (size_t i = 0; i < sizeof bytes; i += 1024)
        bytes[i] = 1;
    return (void)bytes[0], arg;
}

static void test_stack(void **state)
{
    int x;
    pthread_t thread;
    void *got;

    (void)state;
    assert_int_equal(ted4_thread_start(&thread, fill_stack, &x), 0);
    assert_int_equal(pthread_join(thread, &got), 0);
    assert_ptr_equal(got, &x);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_once),    cmocka_unit_test(test_helped),
        cmocka_unit_test(test_woken),   cmocka_unit_test(test_finished),
        cmocka_unit_test(test_allowed), cmocka_unit_test(test_stack),
    };

    return cmocka_run_group_tests_name("threads", tests, NULL, NULL);
}
