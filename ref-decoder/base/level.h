/* level.h - instruction sets that kernels are built for, one of which is chosen when a program
 * runs.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_LEVEL_H
#define TED4_LEVEL_H

/* In rising order. On x86-64 the names are those of its micro-architecture levels. */
typedef enum {
    TED4_LEVEL_PLAIN, /* as BASE, and the decoder without its kernels: norm/ alone */
    TED4_LEVEL_BASE,  /* what every machine of this kind has: SSE2 on x86-64 ("v1"), NEON on aarch64
                         ("neon") */
    TED4_LEVEL_V3,    /* AVX2, FMA, BMI */
    TED4_LEVEL_V4,    /* AVX-512 F, BW, DQ, VL */
    TED4_LEVELS
} ted4_level;

/* The highest level that this machine has. */
ted4_level ted4_level_of_machine(void);
/* The level that the environment variable TED4_KERNEL names, at most that of this machine; without
 * the variable, or with a name that does not exist, that of the machine. */
ted4_level ted4_level_wanted(void);
/* "plain", "v1", "v3", "v4"; other machines' base: "neon" on aarch64, else "base". */
const char *ted4_level_name(ted4_level level);
/* The level of a name; TED4_LEVELS: there is none. */
ted4_level ted4_level_named(const char *name);

#endif
