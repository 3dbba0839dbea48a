/* chance.h - random numbers for recipes. They use integers only, so that every machine draws the
 * same numbers.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef CONF_CHANCE_H
#define CONF_CHANCE_H

#include <stdint.h>

/* splitmix64 */
typedef struct {
    uint64_t state;
} conf_chance;

static inline uint32_t conf_u32(conf_chance *c)
{
    uint64_t z = c->state += 0x9e3779b97f4a7c15u;

    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9u;
    z = (z ^ z >> 27) * 0x94d049bb133111ebu;
    return (uint32_t)(z >> 32);
}

/* Returns an integer in [low, high]; high - low < 2^31. */
static inline int32_t conf_in(conf_chance *c, int32_t low, int32_t high)
{
    return low + (int32_t)(conf_u32(c) % (uint32_t)(high - low + 1));
}

/* Returns a bell-shaped random integer in [-6 sigma, 6 sigma], rounded down: the sum of four
 * uniform numbers. six_sigma < 2^13. */
static inline int32_t conf_bell(conf_chance *c, int32_t six_sigma)
{
    int32_t sum = -131070;

    for (int i = 0; i < 4; i++)
        sum += (int32_t)(conf_u32(c) >> 16);
    return sum * six_sigma /
           227023; /* the standard deviation of the sum is 65536 / sqrt(3) = 37837 */
}

#endif
