/* mutant_place.c - see mutant_place.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "mutant_place.h"

#include <stddef.h>
#include <string.h>
#include "base/level.h"

enum { TEAM = 4 };

static const conf_place places[] = {
    { "", "TED4_KERNEL=plain", NULL, 1, 0 },
    { "v3", "TED4_KERNEL=v3", "AVX2", 1, 0 },
    { "v4", "TED4_KERNEL=v4", "AVX-512", 1, 0 },
    { "vnni", "TED4_KERNEL=v4", "AVX-512 with VNNI", 1, 0 },
    { "no-vnni", "TED4_KERNEL=v4", "AVX-512 without VNNI", 1, 0 },
    { "neon", "TED4_KERNEL=neon", "NEON", 1, 0 },
    { "threads", "TED4_KERNEL=plain", NULL, TEAM, 0 },
    { "printed", "TED4_KERNEL=plain", NULL, 1, 1 },
};

const conf_place *conf_place_at(int i)
{
    return (size_t)i < sizeof places / sizeof *places ? &places[i] : NULL;
}

const conf_place *conf_place_named(const char *name)
{
    for (size_t i = 0; i < sizeof places / sizeof *places; i++)
        if (strcmp(name, places[i].name) == 0)
            return &places[i];
    return NULL;
}

/* Returns 1 if the machine has the VNNI extension of AVX-512. */
static int has_vnni(void)
{
#if defined(__x86_64__)
    return __builtin_cpu_supports("avx512vnni") != 0;
#else
    return 0;
#endif
}

int conf_place_is_here(const conf_place *place)
{
    const ted4_level level = ted4_level_named(strchr(place->variable, '=') + 1);

    if (level == TED4_LEVELS || level > ted4_level_of_machine())
        return 0;
    if (strcmp(place->name, "vnni") == 0)
        return has_vnni();
    return strcmp(place->name, "no-vnni") != 0 || !has_vnni();
}
