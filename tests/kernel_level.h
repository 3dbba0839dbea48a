/* kernel_level.h - other kernels for a part of a test, then again those that TED4_KERNEL named, or this machine's where it
 * named none. A test that took the variable away would leave a suite at one level run the rest at another (make
 * test-machines).
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_KERNEL_LEVEL_H
#define TED4_KERNEL_LEVEL_H

#include <stdio.h>
#include <stdlib.h>

/* name: of a level (base/level.h), from now on; NULL: as the environment was at the first call. */
static inline void kernel_level(const char *name)
{
    static char before[32];
    static int  known;

    if (!known && getenv("TED4_KERNEL") != NULL)
        snprintf(before, sizeof before, "%s", getenv("TED4_KERNEL"));
    known = 1;
    if (name != NULL || before[0] != '\0')
        setenv("TED4_KERNEL", name != NULL ? name : before, 1);
    else
        unsetenv("TED4_KERNEL");
}

#endif
