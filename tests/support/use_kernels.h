/* use_kernels.h - selects other kernels for a part of a test, and afterwards restores those that
 * TED4_KERNEL named, or this machine's default. A test that only removed the variable would run the
 * rest of a suite at the wrong level (make test-machines).
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_USE_KERNELS_H
#define TED4_USE_KERNELS_H

#include <stdio.h>
#include <stdlib.h>

/* level: name of a level (base/level.h); NULL: as the environment was at the first call. */
static inline void use_kernels(const char *level)
{
    static char before[32];
    static int known;

    if (!known && getenv("TED4_KERNEL") != NULL)
        snprintf(before, sizeof before, "%s", getenv("TED4_KERNEL"));
    known = 1;
    if (level != NULL || before[0] != '\0')
        setenv("TED4_KERNEL", level != NULL ? level : before, 1);
    else
        unsetenv("TED4_KERNEL");
}

#endif
