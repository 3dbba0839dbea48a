/* threads.h - the team of threads that programs provide to the libraries through base/parallel.h.
 * Library code only ever sees a const ted4_parallel *.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_THREADS_H
#define TED4_THREADS_H

#include "base/parallel.h"

/* Largest number of threads of a team, and the largest that programs accept. */
enum { TED4_MAX_THREADS = 256 };

/* Returns how many processors this process may use: those of its affinity mask (taskset, cpusets of
 * containers, bindings of mpirun) where the system tells, else those that are online. At least
 * 1. */
int ted4_threads_allowed(void);
/* Fills *p with a parallel-for over n_threads threads, including the caller's. n_threads <= 0 means
 * ted4_threads_allowed(). Each thread has a share of the indices; when it is done, it takes
 * remaining indices of the other shares one at a time, so the cost of the body may vary. Only one
 * thread may use *p at a time. There are at most TED4_MAX_THREADS threads, and fewer if the system
 * cannot create them. */
void ted4_threads_init(ted4_parallel *p, int n_threads);
/* Returns the number of threads of *p. */
int ted4_threads_count(const ted4_parallel *p);
/* Ends the threads and frees the team. */
void ted4_threads_finish(ted4_parallel *p);

#endif
