/* middle.h - a robust mean of what cameras have in common.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_MIDDLE_H
#define TED4_MIDDLE_H

#include <stddef.h>

/* Returns the mean over the values between the outer quartiles (interquartile mean), so that a
 * camera far from the others does not drag the scene along. Sorts x, [n]; n must be above 0. */
double ted4_middle(float *x, size_t n);

#endif
