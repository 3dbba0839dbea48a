/* select_strict.c - which variant of the strict dense layer this machine takes.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <stdlib.h>
#include <string.h>
#include "kernel/strict_dense.h"

ted4_strict_dense_fn ted4_select_strict_dense(void)
{
    const char *want = getenv("TED4_KERNEL");

    if (want != NULL && strcmp(want, "plain") == 0)
        return NULL;
#if defined(__x86_64__)
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
        __builtin_cpu_supports("avx512vl"))
        return ted4_strict_dense_avx512;
    if (__builtin_cpu_supports("avx2"))
        return ted4_strict_dense_avx2;
#endif
    return NULL;
}
