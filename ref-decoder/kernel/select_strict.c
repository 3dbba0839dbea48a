/* select_strict.c - selects the variant of the strict dense layer for the wanted level.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <stddef.h>
#include "base/level.h"
#include "kernel/strict_dense.h"

ted4_strict_dense_fn ted4_select_strict_dense(void)
{
    switch (ted4_level_wanted()) {
#if defined(__x86_64__)
    case TED4_LEVEL_V4: return ted4_strict_dense_avx512;
    case TED4_LEVEL_V3: return ted4_strict_dense_avx2;
#elif defined(__AARCH64EL__)
    case TED4_LEVEL_BASE: return ted4_strict_dense_neon;
#endif
    default: return NULL;
    }
}
