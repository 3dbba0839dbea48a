/* voxel_set.c - a hash set of voxels (voxel_set.h).
 * SPDX-License-Identifier: BSD-2-Clause */
#include "voxel_set.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "random.h"

int ted4_voxel_set_init(ted4_voxel_set *c, size_t n)
{
    size_t size = 64;

    while (size < 2 * n)
        size *= 2;
    c->key = calloc(size, sizeof *c->key);
    c->mask = size - 1;
    c->n = 0;
    return c->key == NULL ? -1 : 0;
}

void ted4_voxel_set_finish(ted4_voxel_set *c)
{
    free(c->key);
    c->key = NULL;
}

void ted4_voxel_set_clear(ted4_voxel_set *c)
{
    memset(c->key, 0, (c->mask + 1) * sizeof *c->key);
    c->n = 0;
}

int ted4_voxel_set_add(ted4_voxel_set *c, uint64_t key)
{
    size_t i = (size_t)ted4_mix(key) & c->mask;

    while (c->key[i] != 0) {
        if (c->key[i] == key)
            return 0;
        i = (i + 1) & c->mask;
    }
    c->key[i] = key;
    c->n++;
    return 1;
}

uint64_t ted4_voxel_key(const float p[3], double voxel)
{
    uint64_t key = 1;

    for (int j = 0; j < 3; j++) {
        const int64_t i = (int64_t)rint((double)p[j] / voxel) + (1 << 20);

        key = key << 21 | ((uint64_t)i & 0x1fffff);
    }
    return key;
}
