/* level.c - implements level.h: detects the level of the machine.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "base/level.h"

#include <stdlib.h>
#include <string.h>

ted4_level ted4_level_of_machine(void)
{
#if defined(__x86_64__)
    /* Kernels are compiled for these instruction sets only, not for all of x86-64-v3. */
    if (!__builtin_cpu_supports("avx2") || !__builtin_cpu_supports("fma") ||
        !__builtin_cpu_supports("bmi") || !__builtin_cpu_supports("bmi2"))
        return TED4_LEVEL_BASE;
    if (!__builtin_cpu_supports("avx512f") || !__builtin_cpu_supports("avx512bw") ||
        !__builtin_cpu_supports("avx512dq") || !__builtin_cpu_supports("avx512vl"))
        return TED4_LEVEL_V3;
    return TED4_LEVEL_V4;
#else
    return TED4_LEVEL_BASE;
#endif
}

const char *ted4_level_name(ted4_level level)
{
    switch (level) {
    case TED4_LEVEL_PLAIN: return "plain";
    case TED4_LEVEL_V3: return "v3";
    case TED4_LEVEL_V4: return "v4";
    default: break;
    }
#if defined(__x86_64__)
    return "v1";
#elif defined(__aarch64__)
    return "neon";
#else
    return "base";
#endif
}

ted4_level ted4_level_named(const char *name)
{
    for (int level = TED4_LEVEL_PLAIN; level < TED4_LEVELS; level++)
        if (strcmp(name, ted4_level_name((ted4_level)level)) == 0)
            return (ted4_level)level;
    return TED4_LEVELS;
}

ted4_level ted4_level_wanted(void)
{
    const ted4_level most = ted4_level_of_machine();
    const char *name = getenv("TED4_KERNEL");
    const ted4_level level = name != NULL ? ted4_level_named(name) : TED4_LEVELS;

    return level < most ? level : most;
}
