/* level.h - the instruction sets for which kernels are built; one of them is chosen when a program
 * starts.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_LEVEL_H
#define TED4_LEVEL_H

/* The levels in increasing order. On x86-64 they are named after its micro-architecture levels. */
typedef enum {
    TED4_LEVEL_PLAIN, /* the instructions of BASE; the decoder does not use the code of kernel/ */
    /* what every machine of its architecture supports: SSE2 on x86-64 ("v1"), NEON on aarch64
     * ("neon") */
    TED4_LEVEL_BASE,
    TED4_LEVEL_V3, /* AVX2, FMA, BMI */
    TED4_LEVEL_V4, /* AVX-512 F, BW, DQ, VL */
    TED4_LEVELS
} ted4_level;

/* Returns the highest level that this machine supports. */
ted4_level ted4_level_of_machine(void);
/* Returns the level named by the environment variable TED4_KERNEL, but at most the level of this
 * machine. Without the variable, or if it names no level, returns the level of this machine. */
ted4_level ted4_level_wanted(void);
/* Returns the name of a level: "plain", "v1", "v3" or "v4". The base level is called "neon" on
 * aarch64, and "base" on machines other than x86-64 and aarch64. */
const char *ted4_level_name(ted4_level level);
/* Returns the level with this name, or TED4_LEVELS if there is none. */
ted4_level ted4_level_named(const char *name);

#endif
