/* select_int.c - selects the variant of the integer dense layer for the wanted level.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "base/level.h"
#include "kernel/int_kernel.h"

const ted4_int_dense *ted4_select_int_dense(void)
{
    switch (ted4_level_wanted()) {
#if defined(__x86_64__)
    case TED4_LEVEL_V4:
        return __builtin_cpu_supports("avx512vnni") ? &ted4_int_dense_vnni : &ted4_int_dense_avx512;
    case TED4_LEVEL_V3: return &ted4_int_dense_avx2;
#elif defined(__AARCH64EL__)
    case TED4_LEVEL_BASE: return &ted4_int_dense_neon;
#endif
    default: return &ted4_int_dense_plain;
    }
}
