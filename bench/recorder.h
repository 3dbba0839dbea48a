/* recorder.h - a team of one thread that measures how long each index of each parallel region
 * takes, and computes how long the region would take on more cores.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_BENCH_RECORDER_H
#define TED4_BENCH_RECORDER_H

#include <stddef.h>

#include "base/parallel.h"

/* The numbers of cores to predict for. */
enum { RECORDER_CORES = 3, RECORDER_MOST_CORES = 32 };
extern const int recorder_cores[RECORDER_CORES];

/* Time to open and close a region on that many cores, in ms: each round of the team costs a few
 * hundred nanoseconds per thread, to pass on the cache line that signals it. */
#define RECORDER_ROUND(cores) (1e-3 + 2e-4 * (double)(cores))

/* Regions since the counts were reset: their total time on one thread and on recorder_cores, and
 * their number. */
typedef struct {
    double work, on[RECORDER_CORES];
    double own;   /* time of the measurement itself and of other programs, not part of work */
    double spent; /* the part of own that this thread spent */
    size_t n;
} recorder_regions;

typedef struct {
    double *duration; /* owned: [capacity] durations of the last region, by index, in ms */
    size_t n, capacity;
    double clock; /* time to read the clock, ms */
    double *kept; /* owned: durations of a region, kept for a later one */
    size_t n_kept;
    recorder_regions regions; /* the caller may reset it at any time */
    /* NULL, or called before each region of n indices. 1: keep the durations of this region. 2: the
     * indices of this region take jobs from a common list, whose durations are proportional to the
     * kept ones. */
    int (*kind)(size_t n);
} recorder;

void recorder_init(recorder *r);
void recorder_finish(recorder *r);
/* Returns a team whose user pointer is r. */
ted4_parallel recorder_team(recorder *r);

/* Returns the CPU time of the calling thread, in ms. */
double recorder_thread_ms(void);

/* Returns when the last job is done if jobs are handed out in order, each to the first free core.
 */
double recorder_schedule(const double *duration, size_t n, int cores);

#endif
