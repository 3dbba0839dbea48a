/* clock.h - the time that passes, for durations. Depends on nothing.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_CLOCK_H
#define TED4_CLOCK_H

#include <time.h>

/* Seconds since some moment, which setting the time of day does not move. */
static inline double ted4_clock(void)
{
    struct timespec t;

    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

#endif
