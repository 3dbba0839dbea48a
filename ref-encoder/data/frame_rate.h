/* frame_rate.h - frames a second of a scene file, and the fraction that stands for them in a header
 * (spec 6.1: rate_num, rate_den). Loaders refuse what no header can say.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_FRAME_RATE_H
#define TED4_FRAME_RATE_H

#include <stdint.h>

/* Numerator and denominator of a header are at most this, and at least 1. */
#define TED4_RATE_MOST ((1 << 24) - 1)

/* Thousandths where they are exact, as of 30 or 23.976; else the last fraction within the bounds
 * that the continued fraction of the rate comes to, as 30000/1001 or 1/60. 0, or -1: the rate is
 * below 1 / TED4_RATE_MOST, above TED4_RATE_MOST, or not a number. */
int ted4_frame_rate(double rate, uint32_t *num, uint32_t *den);

#endif
