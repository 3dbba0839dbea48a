/* compare.h - comparison functions for qsort.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_COMPARE_H
#define TED4_COMPARE_H

/* Sorts floats in ascending order. None may be a NaN. */
static inline int ted4_compare_floats(const void *x, const void *y)
{
    const float a = *(const float *)x, b = *(const float *)y;

    return (a > b) - (a < b);
}

/* Sorts doubles in ascending order. None may be a NaN. */
static inline int ted4_compare_doubles(const void *x, const void *y)
{
    const double a = *(const double *)x, b = *(const double *)y;

    return (a > b) - (a < b);
}

#endif
