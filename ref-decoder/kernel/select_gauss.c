/* select_gauss.c - selects the function that reads several symbols at a time, if the wanted level
 * has one. SPDX-License-Identifier: BSD-2-Clause */
#include <stddef.h>
#include "base/level.h"
#include "kernel/gauss_kernel.h"

ted4_gauss_many ted4_select_gauss_many(void)
{
    switch (ted4_level_wanted()) {
#if defined(__x86_64__)
    case TED4_LEVEL_V4: return ted4_gauss_many_avx512;
    case TED4_LEVEL_V3: return ted4_gauss_many_avx2;
#elif defined(__AARCH64EL__)
    case TED4_LEVEL_BASE: return ted4_gauss_many_neon;
#endif
    default: return NULL;
    }
}
