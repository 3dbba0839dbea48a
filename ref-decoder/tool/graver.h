/* graver.h - the exit code of a program that has worked on several files.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_GRAVER_H
#define TED4_GRAVER_H

#include "cli.h"

/* Returns the graver of two exit codes. Their order is not that of their numbers: a file that is
 * refused counts for more than one with warnings, which may be taken for success. */
static inline int ted4_graver(int a, int b)
{
    static const int weight[] = {
        [TED4_EXIT_FINE] = 0, [TED4_EXIT_WARNED] = 1, [TED4_EXIT_REFUSED] = 2, [TED4_EXIT_TOOL] = 3
    };

    return weight[a] > weight[b] ? a : b;
}

#endif
