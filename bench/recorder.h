/* recorder.h - a team of one thread that takes note of how long each index of each parallel
 * region lasts, and of how long the region would last on more cores.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_BENCH_RECORDER_H
#define TED4_BENCH_RECORDER_H

#include <stddef.h>

#include "base/parallel.h"

/* The numbers of cores that are asked about. */
enum { RECORDER_CORES = 3, RECORDER_MOST_CORES = 32 };
extern const int recorder_cores[RECORDER_CORES];

/* What opening and closing a region takes on as many cores, in ms: a round of the team costs a
 * few hundred nanoseconds a thread, as the cache line that says so goes from one to the next. */
#define RECORDER_ROUND(cores) (1e-3 + 2e-4 * (double)(cores))

/* Regions since they were counted last: the time in them on one thread, and on recorder_cores;
 * how many. */
typedef struct {
    double work, on[RECORDER_CORES];
    double own;   /* what the notes took, and other programs, outside work */
    double spent; /* of own, what this thread spent */
    size_t n;
} recorder_regions;

typedef struct {
    double *duration; /* owned: [capacity] of the last region, by index, in ms */
    size_t n, capacity;
    double clock; /* what reading the clock takes, ms */
    double *kept; /* owned: those of a region to come back to */
    size_t n_kept;
    recorder_regions regions; /* the caller may empty it at any time */
    /* NULL, or asked before each region of n indices: 1: the durations of this region are kept;
     * 2: its indices take turns at a common list of jobs, which last in proportion to those
     * kept. */
    int (*kind)(size_t n);
} recorder;

void recorder_init(recorder *r);
void recorder_finish(recorder *r);
/* The team; r is its user. */
ted4_parallel recorder_team(recorder *r);

/* Time that the calling thread has had of a core, in ms. */
double recorder_thread_ms(void);

/* Jobs handed out in order, each to the core that is free first: when the last one is done. */
double recorder_schedule(const double *duration, size_t n, int cores);

#endif
