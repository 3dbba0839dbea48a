/* voxel_set.h - a set of voxels: open addressing over 64-bit keys. Used when placing anchors.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_VOXEL_SET_H
#define TED4_VOXEL_SET_H

#include <stddef.h>
#include <stdint.h>

/* The smallest initial voxel of training, in normalised space. The voxels of growth, 16 times
 * finer, still have distinct keys. */
#define TED4_FINEST_VOXEL 0x1p-15

typedef struct {
    uint64_t *key; /* owned; 0: free */
    size_t mask, n;
} ted4_voxel_set;

/* Makes room for n keys at half load. Returns 0, or -1 if memory ran out. */
int ted4_voxel_set_init(ted4_voxel_set *c, size_t n);
void ted4_voxel_set_finish(ted4_voxel_set *c);
void ted4_voxel_set_clear(ted4_voxel_set *c);
/* Returns 1 if the key is new, 0 if it was in the set already. The caller must not add more than n
 * keys. */
int ted4_voxel_set_add(ted4_voxel_set *c, uint64_t key);
/* Returns the key of the voxel of p in [-1, 1]^3: 21 bits per axis, never 0. The grid is exact for
 * voxels of at least 2^-19. */
uint64_t ted4_voxel_key(const float p[3], double voxel);

#endif
