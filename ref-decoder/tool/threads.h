/* threads.h - the team of threads that programs lend to the libraries through base/parallel.h.
 * Library code only ever sees a const ted4_parallel *.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_THREADS_H
#define TED4_THREADS_H

#include "base/parallel.h"

/* The most that a team has; what programs accept. */
enum { TED4_MAX_THREADS = 256 };

/* Fills *p with a parallel-for over n_threads threads, the caller's included; n_threads <= 0: one
 * for each processor that is online. Each thread has a share of the indices and, one at a time,
 * takes what is left of the others', so bodies may be uneven. Only one thread may use *p at a time.
 * There are never more than TED4_MAX_THREADS, and fewer where threads cannot be had. */
void ted4_threads_init(ted4_parallel *p, int n_threads);
/* How many threads *p has. */
int ted4_threads_count(const ted4_parallel *p);
/* Ends the threads. */
void ted4_threads_finish(ted4_parallel *p);

#endif
