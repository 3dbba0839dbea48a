/* select_gauss.c - can this machine read several symbols at a time?
 * SPDX-License-Identifier: BSD-2-Clause */
#include <stdlib.h>
#include <string.h>
#include "kernel/gauss_kernel.h"

ted4_gauss_many ted4_select_gauss_many(void)
{
    const char *want = getenv("TED4_KERNEL");

    if (want != NULL && strcmp(want, "v3") == 0)
        return ted4_gauss_many_avx2;
    if (want != NULL && strcmp(want, "plain") == 0)
        return NULL;
#if defined(__x86_64__)
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw")
        && __builtin_cpu_supports("avx512vl"))
        return ted4_gauss_many_avx512;
    if (__builtin_cpu_supports("avx2"))
        return ted4_gauss_many_avx2;
#endif
    return NULL;
}
