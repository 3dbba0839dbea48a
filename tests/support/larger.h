/* larger.h - the maximum that tests of errors need. fmax() skips NaN, so that what is not a number
 * would pass every test.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_LARGER_H
#define TED4_LARGER_H

#include <math.h>

/* Returns the larger of two numbers, and NaN if one of them is NaN. */
static inline double larger(double a, double b)
{
    return isnan(a) || b <= a ? a : b;
}

#endif
