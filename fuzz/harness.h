/* harness.h - what the fuzzing harnesses share: a claim that ends the process when it does not hold, and the bound on a decoder's memory.
 * Each fz_*.c is one libFuzzer entry; main.c replays files through it without libFuzzer; tests/test_fuzz.c includes them all.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_HARNESS_H
#define TED4_HARNESS_H

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

enum { FUZZ_MAX_BYTES = 1 << 26 };

static inline void fuzz_require(int holds, const char *claim)
{
    if (holds)
        return;
    fprintf(stderr, "fuzz: broken: %s\n", claim);
    abort();
}

#endif
