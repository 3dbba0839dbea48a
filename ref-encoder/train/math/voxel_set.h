/* voxel_set.h - a set of voxels: open addressing over 64-bit keys. Used where anchors are placed.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_VOXEL_SET_H
#define TED4_VOXEL_SET_H

#include <stddef.h>
#include <stdint.h>

/* The finest voxel that training begins with, in normalised space: those of growth, 16 times finer,
 * have keys of their own, too. */
#define TED4_FINEST_VOXEL 0x1p-15

typedef struct {
    uint64_t *key; /* owned; 0: free */
    size_t mask, n;
} ted4_voxel_set;

/* Room for n keys at half load. 0, or -1: no memory. */
int ted4_voxel_set_init(ted4_voxel_set *c, size_t n);
void ted4_voxel_set_finish(ted4_voxel_set *c);
void ted4_voxel_set_clear(ted4_voxel_set *c);
/* 1: new, 0: was there. The caller never adds more than n keys. */
int ted4_voxel_set_add(ted4_voxel_set *c, uint64_t key);
/* Key of the voxel of p in [-1, 1]^3: 21 bits an axis, never 0; the grid is exact for voxels of at
 * least 2^-19. */
uint64_t ted4_voxel_key(const float p[3], double voxel);

#endif
