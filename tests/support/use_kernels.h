/* use_kernels.h - other kernels for a part of a test, then again those that TED4_KERNEL named, or
 * this machine's where it named none. A test that took the variable away would leave the suite at
 * one level run at another (make test-machines).
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_USE_KERNELS_H
#define TED4_USE_KERNELS_H

#include <stdio.h>
#include <stdlib.h>

/* Name of a level (base/level.h); NULL: as the environment was at the first call. */
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
