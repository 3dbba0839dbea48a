/* plain_kernels.h - the decoder without its kernels for a part of a test, then again with those that TED4_KERNEL named, or
 * with this machine's where it named none. A test that took the variable away would leave the suite at one level run
 * at another (make test-machines).
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_PLAIN_KERNELS_H
#define TED4_PLAIN_KERNELS_H

#include <stdio.h>
#include <stdlib.h>

/* plain: from now on without kernels; else as the environment was at the first call. */
static inline void plain_kernels(int plain)
{
    static char before[32];
    static int  known;

    if (!known && getenv("TED4_KERNEL") != NULL)
        snprintf(before, sizeof before, "%s", getenv("TED4_KERNEL"));
    known = 1;
    if (plain || before[0] != '\0')
        setenv("TED4_KERNEL", plain ? "plain" : before, 1);
    else
        unsetenv("TED4_KERNEL");
}

#endif
