/* odd_threads.h - schedulers (base/parallel.h) that a caller may supply and that must not affect
 * any result, for the run member of ted4_parallel.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_ODD_THREADS_H
#define TED4_ODD_THREADS_H

#include <stddef.h>

/* Runs the last index first. */
static inline void odd_backwards(void *user, size_t n, void (*body)(void *arg, size_t i), void *arg)
{
    (void)user;
    while (n-- > 0)
        body(arg, n);
}

/* Runs each index on whichever of three threads is free. */
static inline void odd_threads(void *user, size_t n, void (*body)(void *arg, size_t i), void *arg)
{
    (void)user;
#pragma omp parallel for schedule(dynamic, 1) num_threads(3)
    for (size_t i = 0; i < n; i++)
        body(arg, i);
}

#endif
