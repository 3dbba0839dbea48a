/* random_source.h - the random numbers of tests and fuzzers: xorshift64*. The seeds of the fuzzers
 * depend on these numbers, so they must not change.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_RANDOM_SOURCE_H
#define TED4_RANDOM_SOURCE_H

#include <math.h>
#include <stdint.h>

/* The state is never 0. */
typedef struct {
    uint64_t state;
} random_source;

/* Neighbouring seeds give unrelated sequences. seed < 2^64 - 1. */
static inline random_source random_seed(uint64_t seed)
{
    return (random_source) { (seed + 1) * 0x9e3779b97f4a7c15u };
}

/* Uniform, 32 bits. */
static inline uint32_t random_u32(random_source *r)
{
    r->state ^= r->state >> 12;
    r->state ^= r->state << 25;
    r->state ^= r->state >> 27;
    return (uint32_t)(r->state * 0x2545f4914f6cdd1du >> 32);
}

/* Uniform in low .. high, both included; high - low < 2^32 - 1. */
static inline uint32_t random_in(random_source *r, uint32_t low, uint32_t high)
{
    return low + random_u32(r) % (high - low + 1);
}

/* Uniform in [0, 1), in steps of 2^-32. */
static inline double random_unit(random_source *r)
{
    return random_u32(r) / 4294967296.0;
}

/* Uniform between low and high, in 2^24 steps. */
static inline float random_float(random_source *r, float low, float high)
{
    return low + (high - low) * ((float)(random_u32(r) >> 8) * 0x1p-24f);
}

/* Normal, with mean 0 and variance 1 (Box-Muller). */
static inline double random_normal(random_source *r)
{
    const double length = sqrt(-2 * log(1 - random_unit(r)));

    return length * cos(6.283185307179586 * random_unit(r));
}

#endif
