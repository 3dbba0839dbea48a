/* leveled.h - functions of which there is one copy a level: those of drawing and training that take
 * most of the time. A file of them is compiled once a level (LEVELED in the Makefile) and names
 * what it defines by TED4_LEVELED; a file compiled once holds the function of the plain name, which
 * calls the copy of the level in use by TED4_IN_USE. All copies give the same bits where the level
 * has fused multiply-add: only x86-64's base lacks it. Depends on base/level.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_LEVELED_H
#define TED4_LEVELED_H

#include "base/level.h"

/* The level in use: at first the one wanted (base/level.h). Never TED4_LEVEL_PLAIN, which is the
 * base here. */
ted4_level ted4_level_in_use(void);
/* For tests and measurements, while nothing else runs; what has been packed for a level must be
 * packed anew. At most that of the machine. Gives the level from then on. */
ted4_level ted4_level_use(ted4_level level);

#define TED4_JOIN_(a, b) a##_##b
#define TED4_JOIN(a, b)  TED4_JOIN_(a, b)

/* TED4_LEVEL is a macro in files compiled once a level: base, v3 or v4. */
#ifdef TED4_LEVEL
#define TED4_LEVELED(name) TED4_JOIN(name, TED4_LEVEL)
#endif

#if defined(__x86_64__)
#define TED4_EACH_LEVEL(type, name, ...) \
    type name##_base(__VA_ARGS__);       \
    type name##_v3(__VA_ARGS__);         \
    type name##_v4(__VA_ARGS__);         \
    type name(__VA_ARGS__)
#define TED4_IN_USE(name)                               \
    (ted4_level_in_use() == TED4_LEVEL_V4   ? name##_v4 \
     : ted4_level_in_use() == TED4_LEVEL_V3 ? name##_v3 \
                                            : name##_base)
#else
#define TED4_EACH_LEVEL(type, name, ...) \
    type name##_base(__VA_ARGS__);       \
    type name(__VA_ARGS__)
#define TED4_IN_USE(name) name##_base
#endif

/* a b + c, in one rounding where the level has it. For files compiled once a level only: elsewhere
 * the same expression must not depend on the machine. */
#ifdef TED4_LEVEL
#if defined(__FMA__) || defined(__aarch64__) || defined(__FP_FAST_FMAF)
#define TED4_FUSED 1
static inline float ted4_fma(float a, float b, float c)
{
    return __builtin_fmaf(a, b, c);
}
#else
#define TED4_FUSED 0
static inline float ted4_fma(float a, float b, float c)
{
    return a * b + c;
}
#endif
#endif

#endif
