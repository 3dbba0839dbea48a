/* raster_state.h - inside the workspace of raster.h: what its stages hand to each other and to the
 * adjoint. Depends on raster.h, leveled.h. For render/ and its adjoint in ref-encoder/train/ only.
 *
 * Terms: an instance is a (Gaussian, tile) pair. Instances have two orders: by tile and depth
 * ("position"), in which they are blended, and by Gaussian and tile ("instance"), in which their
 * gradients are added up.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_RASTER_STATE_H
#define TED4_RASTER_STATE_H

#include "render/leveled.h"
#include "render/raster.h"

enum {
    TED4_TILE = 16, /* pixels */
    TED4_BLOCK = 4, /* pixels; a block is one vector */
    TED4_TILE_BLOCKS = 16,
    TED4_GROUP = 64,   /* instances whose blocks are noted together */
    TED4_AHEAD = 32,   /* items fetched before they are needed, where they lie anywhere in memory */
    TED4_CHUNK = 1024, /* Gaussians of one projection job; a multiple of 16 */
    TED4_SORT_PARTS = 32, /* jobs of one sorting pass; any number gives the same order */
    TED4_RADIX_BITS = 11, /* of a sorting pass, at most */
    TED4_SPARE = 16,      /* instances that a sorting part may write in vain: a cache line, which no
                             other part writes */
};

/* Memory that is kept from call to call. */
typedef struct {
    void *data; /* owned, 64-byte aligned */
    size_t size;
} ted4_growing;

/* Makes b at least that large; what it held is lost if it must grow. 0, or -1: no memory (b is then
 * empty). */
int ted4_growing_grow(ted4_growing *b, size_t n, size_t element_size);
void ted4_growing_free(ted4_growing *b);

/* What a tile needs of one Gaussian: a cache line, since tiles visit Gaussians in depth order,
 * which is no memory order. */
typedef struct {
    float x, y;       /* centre, pixels */
    float a1, a2, a3; /* n1 = a1 dx + a2 dy, n2 = a3 dy */
    float level;      /* log2(opacity) */
    float colour[3];
    float lean_x, lean_y; /* b / c and b / a: of all points with a given dy, dx = lean_x dy is the
                             most opaque; and vice versa */
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

/* Which of TED4_GROUP successive instances of a tile each of its blocks has to blend: bit i for
 * instance i. */
typedef struct {
    uint64_t block[TED4_TILE_BLOCKS];
} ted4_reach;

/* Number of the first group of a tile whose first position this is: groups of different tiles never
 * meet. */
static inline size_t ted4_group_first(size_t tile, uint32_t position)
{
    return tile + position / TED4_GROUP;
}

struct ted4_raster {
    /* per Gaussian */
    ted4_growing splat2d;        /* ted4_splat2d; only visible ones are set */
    ted4_growing box;            /* ted4_tile_box */
    ted4_growing first_instance; /* uint32_t [n + 1] */
    /* per visible Gaussian: depth bits << 32 | index; sorting goes to and fro between the two */
    ted4_growing key[2];
    /* per projection job */
    ted4_growing chunk; /* ted4_chunk */
    /* sorting */
    ted4_growing hist;       /* uint32_t [TED4_SORT_PARTS][n_tiles + 3 or 1 << TED4_RADIX_BITS] */
    ted4_growing tile_first; /* uint32_t [n_tiles + 1]: first position of each tile */
    /* per instance, by position */
    ted4_growing owner;    /* uint32_t: Gaussian; TED4_AHEAD more at the end, of Gaussian 0; then
                              bin.c's spare ones */
    ted4_growing instance; /* uint32_t; as many */
    /* per ted4_group_first group of instances */
    ted4_growing reach; /* ted4_reach (kept for the adjoint) */

    size_t n_visible, n_instances;
    uint32_t tiles_x, tiles_y;
    uint64_t n_skipped; /* see ted4_raster_skipped */
};

/* What projection counts in one job, and then the totals of the jobs before it; and the depth bits
 * of the nearest and the farthest Gaussian that is visible: UINT32_MAX and 0 where none is. */
typedef struct {
    uint32_t n_visible, n_instances, n_skipped;
    uint32_t nearest, farthest;
} ted4_chunk;

/* The stages of ted4_raster_forward. Each: 0, or -1: no memory. */
TED4_EACH_LEVEL(int, ted4_raster_project, struct ted4_raster *r, const ted4_splats *s,
                const ted4_view *v, const ted4_parallel *p);
int ted4_raster_bin(struct ted4_raster *r, const ted4_splats *s, const ted4_parallel *p);
TED4_EACH_LEVEL(int, ted4_raster_blend, struct ted4_raster *r, const ted4_view *v,
                const ted4_parallel *p, int keep_state, float *image);

#endif
