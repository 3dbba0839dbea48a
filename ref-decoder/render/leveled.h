/* leveled.h - functions that are compiled once per level of the machine: those in which rendering
 * and training spend most of the time. A file of such functions is compiled once per level (LEVELED
 * in the Makefile) and forms their names with TED4_LEVELED. Another file, compiled only once, holds
 * the function of the plain name, which calls the copy of the level in use with TED4_IN_USE. All
 * copies give the same bits on levels that have fused multiply-add; only the base of x86-64 lacks
 * it. Depends on base/level.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_LEVELED_H
#define TED4_LEVELED_H

#include "base/level.h"

/* Returns the level in use, which at first is the one wanted (base/level.h). It is never
 * TED4_LEVEL_PLAIN: the base takes its place. */
ted4_level ted4_level_in_use(void);
/* Sets the level in use, but no higher than that of the machine, and returns it. For tests and
 * measurements only, while no other thread runs; data packed for another level must be packed
 * again. */
ted4_level ted4_level_use(ted4_level level);

#define TED4_JOIN_(a, b) a##_##b
#define TED4_JOIN(a, b)  TED4_JOIN_(a, b)

/* In files compiled once per level, the macro TED4_LEVEL is base, v3 or v4. */
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

/* Returns a b + c, with a single rounding on levels that have fused multiply-add. Only for files
 * compiled once per level: in other files results must not depend on the machine. */
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
