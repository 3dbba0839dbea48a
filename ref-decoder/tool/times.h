/* times.h - parses the times of a scene that a command line requests.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_TIMES_H
#define TED4_TIMES_H

#include <stdint.h>

/* The time num / den in the form of spec 11. */
typedef struct {
    uint32_t num, den;
} ted4_time;

/* The frames first, first + step, ... below end. If end is UINT32_MAX, the last frame of the scene
 * ends the range. */
typedef struct {
    uint32_t first, end, step;
} ted4_range;

/* Parses "A:B:STEP" as in Python: from A up to, but not including, B. Each part may be missing,
 * also with its colon. "A" alone is that one frame. Returns 0, or -1. */
int ted4_range_parse(const char *text, ted4_range *r);

/* Parses a decimal fraction with up to 7 digits after the point ("0.25"), or "N/D" with D below
 * 2^24, without rounding. The time must be within [0, 1]. Returns 0, or -1. */
int ted4_time_parse(const char *text, ted4_time *t);

/* The time num / den seconds after the first frame. */
typedef struct {
    uint64_t num;
    uint32_t den; /* a power of 10, at most 10^7 */
} ted4_seconds;

/* Parses a decimal number of seconds below 10^6 with up to 7 digits after the point, followed by
 * "s": "1.5s", ".5s". Returns 0, or -1. */
int ted4_seconds_parse(const char *text, ted4_seconds *s);

/* R-MED-001: returns the time of a scene of n_frames at rate_num / rate_den frames per second, all
 * at least 1, that lies s after its first frame; the first or last frame's where there is none. */
ted4_time ted4_time_of_seconds(ted4_seconds s, uint32_t n_frames, uint32_t rate_num,
                               uint32_t rate_den);

/* Returns the time that is this part of the whole, from 0 to 1, in steps of 10^-7. */
ted4_time ted4_time_of_part(double part);

/* R-HDR-005: returns the time of a frame. frame < n_frames, n_frames >= 1. */
ted4_time ted4_time_of_frame(uint32_t frame, uint32_t n_frames);

#endif
