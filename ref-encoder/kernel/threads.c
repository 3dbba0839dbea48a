/* threads.c - see threads.h. The number of threads travels in the user pointer, so nothing is allocated and nothing is global.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "kernel/threads.h"

#include <omp.h>
#include <stdint.h>

static void run(void *user, size_t n, void (*body)(void *arg, size_t i), void *arg)
{
    const int n_threads = (int)(intptr_t)user;

#pragma omp parallel for schedule(dynamic, 1) num_threads(n_threads)
    for (size_t i = 0; i < n; i++)
        body(arg, i);
}

void ted4_threads_init(ted4_parallel *p, int n_threads)
{
    if (n_threads <= 0)
        n_threads = omp_get_num_procs();
    p->run  = run;
    p->user = (void *)(intptr_t)n_threads;
}

int ted4_threads_count(const ted4_parallel *p)
{
    return p == NULL ? 1 : (int)(intptr_t)p->user;
}
