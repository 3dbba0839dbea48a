/* times.h - which times of a scene a command line asks for.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_TIMES_H
#define TED4_TIMES_H

#include <stdint.h>

/* Time num / den as spec 11 takes it. */
typedef struct {
    uint32_t num, den;
} ted4_time;

/* Frames first, first + step, ... below end; end UINT32_MAX: to the last. */
typedef struct {
    uint32_t first, end, step;
} ted4_range;

/* "A:B:STEP" as in Python: from A up to, not including, B; each part may be missing, also its
 * colon. "A" alone is that frame. 0, or -1. */
int ted4_range_parse(const char *text, ted4_range *r);

/* A decimal fraction with up to 7 digits behind the point ("0.25"), or "N/D"; exact; within [0, 1],
 * D below 2^24. 0, or -1. */
int ted4_time_parse(const char *text, ted4_time *t);

/* R-HDR-005: the time of frame < n_frames, n_frames >= 1. */
ted4_time ted4_time_of_frame(uint32_t frame, uint32_t n_frames);

#endif
