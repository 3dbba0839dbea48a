/* raster_state.h - the contents of the workspace of raster.h: the data that its stages pass to each
 * other and to the adjoint. Depends on raster.h, leveled.h. Only for render/ and the adjoint in
 * ref-encoder/train/.
 *
 * Terms: an instance is a (Gaussian, tile) pair. Instances are numbered in two orders: by tile and
 * depth ("position"), in which they are blended, and by Gaussian and tile ("instance"), in which
 * their gradients are added up.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_RASTER_STATE_H
#define TED4_RASTER_STATE_H

#include "render/leveled.h"
#include "render/raster.h"

enum {
    TED4_TILE = 16,        /* side of a tile, pixels */
    TED4_BLOCK = 4,        /* side of a block, pixels; a block is one lane group */
    TED4_TILE_BLOCKS = 16, /* blocks per tile */
    TED4_GROUP = 64,       /* instances per group: a ted4_reach stores the blocks that they reach */
    TED4_AHEAD = 32,       /* prefetch distance for items scattered over memory */
    TED4_CHUNK = 1024,     /* Gaussians per projection job; a multiple of 16 */
    TED4_SORT_PARTS = 32,  /* jobs per sorting pass; any number gives the same order */
    TED4_RADIX_BITS = 11,  /* maximum number of bits per sorting pass */
    TED4_SPARE = 16,       /* space for unused instances of one sorting part: a cache line, so that
                              no other part writes to it */
};

/* A buffer that is kept from call to call. */
typedef struct {
    void *data; /* owned, 64-byte aligned */
    size_t size;
} ted4_growing;

/* Makes b large enough for n elements; its contents are lost if it has to grow. Returns 0, or -1
 * with b empty if out of memory. */
int ted4_growing_grow(ted4_growing *b, size_t n, size_t element_size);
void ted4_growing_free(ted4_growing *b);

/* The data of one Gaussian that a tile needs. It fills one cache line, since tiles visit Gaussians
 * in order of depth, scattered over memory. */
typedef struct {
    float x, y;       /* centre, pixels */
    float a1, a2, a3; /* n1 = a1 dx + a2 dy, n2 = a3 dy */
    float level;      /* log2(opacity) */
    float colour[3];
    float lean_x, lean_y; /* b / c and b / a: among all points with a given dy, that with
                             dx = lean_x dy is the most opaque; likewise dy = lean_y dx */
    float unused[5];
} ted4_splat2d;

/* Tiles [x0, x1) x [y0, y1); empty when the Gaussian is not visible. */
typedef struct {
    uint16_t x0, y0, x1, y1;
} ted4_tile_box;

static inline uint32_t ted4_tile_box_area(ted4_tile_box b)
{
    return (uint32_t)(b.x1 - b.x0) * (uint32_t)(b.y1 - b.y0);
}

/* For each block of a tile, the instances that it has to blend among TED4_GROUP successive ones:
 * bit i stands for instance i. */
typedef struct {
    uint64_t block[TED4_TILE_BLOCKS];
} ted4_reach;

/* Returns the number of the first group of a tile, given its first position. Groups of different
 * tiles get different numbers. */
static inline size_t ted4_group_first(size_t tile, uint32_t position)
{
    return tile + position / TED4_GROUP;
}

struct ted4_raster {
    /* per Gaussian */
    ted4_growing splat2d;        /* ted4_splat2d; only visible ones are set */
    ted4_growing box;            /* ted4_tile_box */
    ted4_growing first_instance; /* uint32_t [n + 1] */
    /* per visible Gaussian: depth bits << 32 | index; each sorting pass moves the keys from one of
     * the two to the other */
    ted4_growing key[2];
    /* per projection job */
    ted4_growing chunk; /* ted4_chunk */
    /* sorting */
    ted4_growing hist;       /* uint32_t [TED4_SORT_PARTS][n_tiles + 3 or 1 << TED4_RADIX_BITS] */
    ted4_growing tile_first; /* uint32_t [n_tiles + 1]: first position of each tile */
    /* per instance, by position */
    ted4_growing owner; /* uint32_t: Gaussian; followed by TED4_AHEAD entries for Gaussian 0, then
                           by the spare ones of bin.c */
    ted4_growing instance; /* uint32_t: instance number; as many entries */
    /* per group of instances, numbered as by ted4_group_first */
    ted4_growing reach; /* ted4_reach (kept for the adjoint) */

    size_t n_visible, n_instances;
    uint32_t tiles_x, tiles_y;
    uint64_t n_skipped; /* see ted4_raster_skipped */
};

/* The counts of one projection job, which bin.c replaces by the totals of the jobs before it; and
 * the depth bits of the nearest and the farthest visible Gaussian, UINT32_MAX and 0 if there is
 * none. */
typedef struct {
    uint32_t n_visible, n_instances, n_skipped;
    uint32_t nearest, farthest;
} ted4_chunk;

/* The stages of ted4_raster_forward. Each returns 0, or -1 if out of memory. */
TED4_EACH_LEVEL(int, ted4_raster_project, struct ted4_raster *r, const ted4_splats *s,
                const ted4_view *v, const ted4_parallel *p);
int ted4_raster_bin(struct ted4_raster *r, const ted4_splats *s, const ted4_parallel *p);
TED4_EACH_LEVEL(int, ted4_raster_blend, struct ted4_raster *r, const ted4_view *v,
                const ted4_parallel *p, int keep_state, float *image);

#endif
