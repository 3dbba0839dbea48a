/* select_int.c - which variant of the integer dense layer this machine takes.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <stdlib.h>
#include <string.h>
#include "kernel/int_kernel.h"

const ted4_int_dense *ted4_select_int_dense(void)
{
    const char *want = getenv("TED4_KERNEL");

    if (want != NULL && strcmp(want, "plain") == 0)
        return &ted4_int_dense_plain;
#if defined(__x86_64__)
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw")
        && __builtin_cpu_supports("avx512vl"))
        return &ted4_int_dense_avx512;
    if (__builtin_cpu_supports("avx2"))
        return &ted4_int_dense_avx2;
#endif
    return &ted4_int_dense_plain;
}
