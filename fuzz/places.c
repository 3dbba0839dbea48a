/* places.c - see places.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "places.h"

#include <stdlib.h>
#include "norm/half.h"

enum { NEAR_BITS = 4, NEAR = 1 << 3 * NEAR_BITS };

static int is_legal(const uint16_t *p)
{
    for (int j = 0; j < 3; j++)
        if ((p[j] & 0x7fff) > 0x3c00 || p[j] == 0x8000)
            return 0;
    return 1;
}

static uint32_t nearest_place(uint16_t h, unsigned depth)
{
    const int32_t half = (int32_t)1 << (depth - 1);

    if (depth == 16)
        return ted4_half_order(h);
    return (uint32_t)ted4_clamp(ted4_floor_shift(ted4_half_q24(h) + (1 << (24 - depth)),
                                                 25 - depth),
                                -half, half - 1) +
           (uint32_t)half;
}

static uint64_t key_of(uint32_t x, uint32_t y, uint32_t z)
{
    return ted4_spread3(x) << 2 | ted4_spread3(y) << 1 | ted4_spread3(z);
}

static int compare(const void *a, const void *b)
{
    const uint64_t x = *(const uint64_t *)a, y = *(const uint64_t *)b;

    return (x > y) - (x < y);
}

/* Sorts key[n], and drops those that are there twice. Returns how many remain. */
static size_t sort(uint64_t *key, size_t n)
{
    size_t kept = 0;

    qsort(key, n, sizeof *key, compare);
    for (size_t i = 0; i < n; i++)
        if (kept == 0 || key[i] != key[kept - 1])
            key[kept++] = key[i];
    return kept;
}

/* Appends keys of free places to the n_has sorted ones, up to n. Returns how many there are. */
static size_t fill_up(uint64_t *key, size_t n_has, size_t n, unsigned depth)
{
    const uint32_t middle = (uint32_t)1 << (depth - 1), mask = (1 << NEAR_BITS) - 1;
    size_t all = n_has;

    for (uint32_t i = 0; i < NEAR && all < n; i++) {
        const uint64_t k = key_of(middle + (i & mask), middle + (i >> NEAR_BITS & mask),
                                  middle + (i >> 2 * NEAR_BITS));

        if (bsearch(&k, key, n_has, sizeof *key, compare) == NULL)
            key[all++] = k;
    }
    return all;
}

int fuzz_settle(uint16_t *position, size_t n, unsigned depth)
{
    uint64_t *const key = malloc((n + 1) * sizeof *key);
    size_t kept = 0;
    int settled;

    if (key == NULL)
        return 0;
    for (const uint16_t *p = position; p < position + 3 * n; p += 3)
        if (is_legal(p))
            key[kept++] = key_of(nearest_place(p[0], depth), nearest_place(p[1], depth),
                                 nearest_place(p[2], depth));
    kept = sort(key, kept);
    settled = fill_up(key, kept, n, depth) == n;
    if (settled)
        (void)sort(key, n);
    for (size_t i = 0; settled && i < 3 * n; i++)
        position[i] = ted4_grid_half(ted4_gather3(key[i / 3] >> (2 - i % 3)), depth);
    free(key);
    return settled;
}
