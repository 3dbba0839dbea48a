/* harness.h - what the fuzzing harnesses share: a claim that ends the process if it does not hold,
 * numbers read from an input, and the limit on a decoder's memory. Each fz_*.c is one libFuzzer
 * entry; list.def names them all; main.c replays files through them without libFuzzer.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_HARNESS_H
#define TED4_HARNESS_H

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

enum { FUZZ_MAX_BYTES = 1 << 26 };

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static inline void fuzz_require(int holds, const char *claim)
{
    if (holds)
        return;
    fprintf(stderr, "fuzz: broken: %s\n", claim);
    abort();
}

/* Numbers read from an input, little-endian; 0 beyond its end. */
typedef struct {
    const uint8_t *at, *end;
} fuzz_source;

static inline uint64_t fuzz_take(fuzz_source *s, unsigned bytes)
{
    uint64_t v = 0;

    for (unsigned i = 0; i < bytes && s->at < s->end; i++)
        v |= (uint64_t)*s->at++ << 8 * i;
    return v;
}

static inline uint8_t fuzz_u8(fuzz_source *s)
{
    return (uint8_t)fuzz_take(s, 1);
}

static inline uint16_t fuzz_u16(fuzz_source *s)
{
    return (uint16_t)fuzz_take(s, 2);
}

static inline uint32_t fuzz_u32(fuzz_source *s)
{
    return (uint32_t)fuzz_take(s, 4);
}

/* Returns a number in low .. high, both included. */
static inline uint32_t fuzz_in(fuzz_source *s, uint32_t low, uint32_t high)
{
    return low + fuzz_u16(s) % (high - low + 1);
}

#endif
