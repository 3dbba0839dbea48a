/* middle.c - see middle.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "middle.h"

#include <stdlib.h>

static int compare(const void *x, const void *y)
{
    const float a = *(const float *)x, b = *(const float *)y;

    return a < b ? -1 : a > b;
}

double ted4_middle(float *x, size_t n)
{
    const size_t out = n / 4;
    double sum = 0;

    qsort(x, n, sizeof *x, compare);
    for (size_t i = out; i < n - out; i++)
        sum += (double)x[i];
    return sum / (double)(n - 2 * out);
}
