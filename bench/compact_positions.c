/* compact_positions.c - see compact.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <math.h>
#include <stdlib.h>
#include "compact.h"
#include "compact_counter.h"
#include "norm/half.h"
#include "norm/octree.h"

static int compare(const void *a, const void *b)
{
    const uint64_t x = *(const uint64_t *)a, y = *(const uint64_t *)b;

    return (x > y) - (x < y);
}

/* The place of a coordinate on the grid, 0 .. 2^depth - 1. */
static uint32_t place(uint16_t p, unsigned depth)
{
    const double half = ldexp(1, (int)depth - 1);

    if (depth == TED4_OCTREE_DEPTH)
        return ted4_half_order(p);
    return (uint32_t)fmin(rint(half * (double)ted4_half_to_float(p)) + half, 2 * half - 1);
}

double compact_octree(const ted4_scene *s, unsigned depth, size_t *shared)
{
    const size_t n = s->head.n_anchors;
    uint64_t *const key = compact_need(n, sizeof *key);
    uint16_t *const position = compact_need(3 * n, sizeof *position);
    compact_counter c = { .base = { .ops = &compact_counter_ops } };
    size_t n_keys = 0;

    for (size_t i = 0; i < n; i++)
        key[i] = ted4_spread3(place(s->position[3 * i], depth)) << 2 |
                 ted4_spread3(place(s->position[3 * i + 1], depth)) << 1 |
                 ted4_spread3(place(s->position[3 * i + 2], depth));
    qsort(key, n, sizeof *key, compare);
    for (size_t i = 0; i < n; i++)
        if (i == 0 || key[i] != key[n_keys - 1])
            key[n_keys++] = key[i];
    for (size_t i = 0; i < 3 * n_keys; i++)
        position[i] = ted4_grid_half(ted4_gather3(key[i / 3] >> (2 - i % 3)), depth);
    ted4_octree_walk(&c.base, depth, n_keys, position);
    *shared = n - n_keys;
    free(key);
    free(position);
    return c.bits;
}

void compact_move_to_grid(ted4_scene *s, unsigned depth)
{
    const double half = ldexp(1, (int)depth - 1);

    for (size_t i = 0; i < 3 * (size_t)s->head.n_anchors; i++)
        s->position[i] = ted4_float_to_half((float)((place(s->position[i], depth) - half) / half));
}
