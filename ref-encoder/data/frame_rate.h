/* frame_rate.h - the fraction that represents a scene file's frames per second in a header (spec
 * 6.1: rate_num, rate_den). Loaders refuse rates that a header cannot represent.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_FRAME_RATE_H
#define TED4_FRAME_RATE_H

#include <stdint.h>

/* Largest numerator and denominator in a header; both are at least 1. */
#define TED4_RATE_MOST ((1 << 24) - 1)

/* Gives rate as a fraction: thousandths where these are exact (30, 23.976), else the last
 * convergent of the rate's continued fraction that is within the bounds (30000/1001, 1/60). Returns
 * 0, or -1 if the rate is below 1 / TED4_RATE_MOST, above TED4_RATE_MOST, or not a number. */
int ted4_frame_rate(double rate, uint32_t *num, uint32_t *den);

#endif
