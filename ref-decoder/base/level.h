/* level.h - the instruction sets for which kernels are built; one of them is chosen when a program
 * starts.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_LEVEL_H
#define TED4_LEVEL_H

/* The levels in rising order. On x86-64 their names are those of its micro-architecture levels. */
typedef enum {
    TED4_LEVEL_PLAIN, /* as BASE, and the decoder runs without its kernels: norm/ alone */
    /* what every machine of this kind supports: SSE2 on x86-64 ("v1"), NEON on aarch64 ("neon") */
    TED4_LEVEL_BASE,
    TED4_LEVEL_V3, /* AVX2, FMA, BMI */
    TED4_LEVEL_V4, /* AVX-512 F, BW, DQ, VL */
    TED4_LEVELS
} ted4_level;

/* Returns the highest level that this machine supports. */
ted4_level ted4_level_of_machine(void);
/* Returns the level that the environment variable TED4_KERNEL names, at most that of this machine.
 * Without the variable, or if no level has that name, returns that of the machine. */
ted4_level ted4_level_wanted(void);
/* Returns the name of a level: "plain", "v1", "v3", "v4". The base of other machines is called
 * "neon" on aarch64 and "base" elsewhere. */
const char *ted4_level_name(ted4_level level);
/* Returns the level of a name, or TED4_LEVELS if there is none. */
ted4_level ted4_level_named(const char *name);

#endif
