/* leveled.c - chooses and stores the level in use (leveled.h).
 * SPDX-License-Identifier: BSD-2-Clause */
#include "render/leveled.h"

#include <stdatomic.h>

/* 0, which is TED4_LEVEL_PLAIN, means that no level has been chosen yet. Threads that choose at the
 * same time choose the same level. */
static atomic_int in_use;

ted4_level ted4_level_use(ted4_level level)
{
    const ted4_level most = ted4_level_of_machine();
    const ted4_level least = level < TED4_LEVEL_BASE ? TED4_LEVEL_BASE : level;
    const ted4_level chosen = least < most ? least : most;

    atomic_store_explicit(&in_use, (int)chosen, memory_order_relaxed);
    return chosen;
}

ted4_level ted4_level_in_use(void)
{
    const int level = atomic_load_explicit(&in_use, memory_order_relaxed);

    return level != 0 ? (ted4_level)level : ted4_level_use(ted4_level_wanted());
}
