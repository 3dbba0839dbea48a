/* random.h - counter-based random numbers for the trainer: each is a function of (key, counter), so
 * results do not depend on the order of calls.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_RANDOM_H
#define TED4_RANDOM_H

#include <stdint.h>

/* Two rounds of xor-shift and multiplication by odd constants: a bijection of 64 bits. The first
 * constant consists of digits of pi. */
static inline uint64_t ted4_mix_rounds(uint64_t x, unsigned first_shift, uint64_t second)
{
    x = (x ^ (x >> first_shift)) * 0x243f6a8885a308d3u;
    x = (x ^ (x >> 29)) * second;
    return x ^ (x >> 32);
}

/* A bijective mix of 64 bits; the sum with the golden ratio keeps 0 from being mapped to 0. */
static inline uint64_t ted4_mix(uint64_t x)
{
    return ted4_mix_rounds(x + 0x9e3779b97f4a7c15u, 31, 0x13198a2e03707345u);
}

/* The same without the sum, for quantisation noise, which adds it to its key once. */
static inline uint64_t ted4_mix_short(uint64_t x)
{
    return ted4_mix_rounds(x, 32, 0xa4093822299f31d1u);
}

/* Returns 64 uniform bits of the stream of a key. */
static inline uint64_t ted4_random(uint64_t key, uint64_t counter)
{
    return ted4_mix(ted4_mix(key) ^ (counter * 0xd1342543de82ef95u));
}

/* Returns a uniform number in [0, 1) with 24 bits. */
static inline float ted4_uniform(uint64_t key, uint64_t counter)
{
    return (float)(ted4_random(key, counter) >> 40) * 0x1p-24f;
}

/* Returns a uniform integer in [0, n), n > 0; the bias of the product method is below n / 2^32. */
static inline uint32_t ted4_below(uint64_t key, uint64_t counter, uint32_t n)
{
    return (uint32_t)(((ted4_random(key, counter) >> 32) * n) >> 32);
}

#endif
