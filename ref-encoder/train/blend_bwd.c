/* blend_bwd.c - adjoint of render/blend.c, a tile at a time.
 *
 * With T the transmittance before a Gaussian, C the colour of everything behind it as it would look if it were the first, and D the
 * pixel's gradient,
 *     image = ... + T (alpha colour + (1 - alpha) C),   dL/dalpha = T (colour - C) . D,   dL/dcolour = alpha T D,
 * so walking back to front only C . D need be carried: behind <- behind + alpha (colour . D - behind). Nothing is divided by
 * 1 - alpha: opacities and weights come from a first walk, front to back, that repeats what the forward pass did.
 *
 * The first walk goes block by block (T stays in a register), the second Gaussian by Gaussian (the sums over pixels do).
 * SPDX-License-Identifier: BSD-2-Clause */
#include "train/raster_adjoint.h"

#include <stdatomic.h>

enum { AHEAD = 8 };             /* slots fetched before they are needed: they lie anywhere in memory */

typedef struct {
    struct ted4_raster *r;
    const ted4_view    *v;
    const float        *d_image;
    atomic_size_t       next_tile;
    atomic_int          failed;
} bwd_job;

/* A Gaussian at a block's pixels, as blended. */
typedef struct {
    ted4_vf alpha, w;
} blended;

typedef struct {
    ted4_vf  px, py;
    ted4_vf  d[3];              /* dL / d colour; 0 outside the image */
    ted4_vf  behind;            /* C . D */
    size_t   first, end;        /* its share of the tile's pairs; end moves to the front in the second walk */
} block_state;

/* A tile at work. */
typedef struct {
    ted4_splat2d       *splat;          /* [n] copies, back to back: the originals lie on as many pages as they are */
    const uint32_t     *slot;           /* [n] */
    const ted4_reach   *reach;          /* [n_groups] */
    uint32_t            n, n_groups;
    blended            *pair;           /* all pairs, block after block */
    uint16_t           *mask;           /* [n] bit b: has a pair in block b */
    block_state         state[TED4_TILE_BLOCKS];
} tile_state;

/* Horizontal sums of 8 vectors, pairwise: halves, quarters, then neighbours are added. */
TED4_INLINE void sum8(const ted4_vf v[8], float out[8])
{
    ted4_vf h[4], q[2], e;

    for (int i = 0; i < 4; i++) {
        const ted4_vf a = v[2 * i], b = v[2 * i + 1];
        h[i] = __builtin_shufflevector(a, b, 0, 1, 2, 3, 4, 5, 6, 7, 16, 17, 18, 19, 20, 21, 22, 23)
             + __builtin_shufflevector(a, b, 8, 9, 10, 11, 12, 13, 14, 15, 24, 25, 26, 27, 28, 29, 30, 31);
    }
    for (int i = 0; i < 2; i++) {
        const ted4_vf a = h[2 * i], b = h[2 * i + 1];
        q[i] = __builtin_shufflevector(a, b, 0, 1, 2, 3, 8, 9, 10, 11, 16, 17, 18, 19, 24, 25, 26, 27)
             + __builtin_shufflevector(a, b, 4, 5, 6, 7, 12, 13, 14, 15, 20, 21, 22, 23, 28, 29, 30, 31);
    }
    e = __builtin_shufflevector(q[0], q[1], 0, 1, 4, 5, 8, 9, 12, 13, 16, 17, 20, 21, 24, 25, 28, 29)
      + __builtin_shufflevector(q[0], q[1], 2, 3, 6, 7, 10, 11, 14, 15, 18, 19, 22, 23, 26, 27, 30, 31);
    e += __builtin_shufflevector(e, e, 1, 0, 3, 2, 5, 4, 7, 6, 9, 8, 11, 10, 13, 12, 15, 14);
    e = __builtin_shufflevector(e, e, 0, 2, 4, 6, 8, 10, 12, 14, 0, 2, 4, 6, 8, 10, 12, 14);
    memcpy(out, &e, 8 * sizeof *out);
}

TED4_INLINE float sum1(ted4_vf v)
{
    v += __builtin_shufflevector(v, v, 8, 9, 10, 11, 12, 13, 14, 15, 0, 1, 2, 3, 4, 5, 6, 7);
    v += __builtin_shufflevector(v, v, 4, 5, 6, 7, 0, 1, 2, 3, 12, 13, 14, 15, 8, 9, 10, 11);
    v += __builtin_shufflevector(v, v, 2, 3, 0, 1, 6, 7, 4, 5, 10, 11, 8, 9, 14, 15, 12, 13);
    return v[0] + v[1];
}

static void load_block(const bwd_job *job, block_state *s, size_t x, size_t y)
{
    const size_t width = (size_t)job->v->width, height = (size_t)job->v->height;
    const size_t n = x >= width ? 0 : width - x < TED4_BLOCK ? width - x : TED4_BLOCK;

    s->behind = ted4_vf_all(0.0f);
    for (size_t k = 0; k < 3; k++) {
        float d[TED4_VEC] = {0};

        for (size_t row = 0; row < TED4_BLOCK && y + row < height; row++)
            memcpy(d + row * TED4_BLOCK, job->d_image + (k * height + y + row) * width + x, n * sizeof *d);
        s->d[k] = ted4_vf_load(d);
        s->behind += job->v->background[k] * s->d[k];
    }
}

/* Gives each block its share of the pairs, and copies the tile's Gaussians together. 0, or -1: no memory. */
static int share_pairs(tile_state *tile, const ted4_splat2d *splat, const uint32_t *owner, ted4_growing *scratch)
{
    size_t total = 0;

    for (int b = 0; b < TED4_TILE_BLOCKS; b++) {
        tile->state[b].first = total;
        for (uint32_t group = 0; group < tile->n_groups; group++)
            total += (size_t)__builtin_popcountll(tile->reach[group].block[b]);
        tile->state[b].end = total;
    }
    /* a Gaussian and its mask fit in two pairs' room */
    if (ted4_growing_grow(scratch, total + 2 * (size_t)tile->n, sizeof(blended)) != 0)
        return -1;
    tile->pair  = scratch->data;
    tile->splat = (ted4_splat2d *)(tile->pair + total);
    tile->mask  = (uint16_t *)(tile->splat + tile->n);
    memset(tile->mask, 0, tile->n * sizeof *tile->mask);
    for (uint32_t i = 0; i < tile->n; i++) {
        __builtin_prefetch(&splat[owner[i + TED4_AHEAD]]);
        tile->splat[i] = splat[owner[i]];
    }
    return 0;
}

/* First walk: what blend.c's blend_block did, keeping opacities and weights. */
static void walk_block(tile_state *tile, int b, const ted4_view *v)
{
    const block_state *s = &tile->state[b];
    const ted4_vf      px = s->px, py = s->py;
    ted4_vf            t = ted4_vf_keep((px < (float)v->width) & (py < (float)v->height), ted4_vf_all(1.0f));
    blended           *pair = tile->pair + s->first;

    for (uint32_t group = 0; group < tile->n_groups; group++)
        for (uint64_t rest = tile->reach[group].block[b]; rest != 0; rest &= rest - 1, pair++) {
            const uint32_t i = group * TED4_GROUP + (uint32_t)__builtin_ctzll(rest);

            ted4_blend_step(&tile->splat[i], px, py, &t, &pair->alpha, &pair->w);
            tile->mask[i] |= (uint16_t)(1u << b);
        }
}

/* Second walk, one Gaussian of the tile: takes its last pair off each block in mask and sums over their pixels. */
static void sum_splat(const ted4_splat2d *g, uint32_t mask, block_state *state, const blended *pair, float *sums, float *sum0)
{
    ted4_vf sum[TED4_GRAD_SUMS] = {{0}}, total = {0};

    for (uint32_t rest = mask; rest != 0; rest &= rest - 1) {
        block_state *s = &state[__builtin_ctz(rest)];
        const blended p = pair[--s->end];
        const ted4_vf ahead = g->colour[0] * s->d[0] + g->colour[1] * s->d[1] + g->colour[2] * s->d[2] - s->behind;
        /* alpha = min(cap, o exp(-e)): d alpha / d ln(o exp(-e)) is alpha, or 0 where capped */
        const ted4_vf d = ted4_vf_keep(p.alpha < TED4_RASTER_ALPHA_MAX, p.w * ahead);
        ted4_vf n1, n2;

        ted4_splat_log2_alpha(g, s->px, s->py, &n1, &n2);
        s->behind += p.alpha * ahead;
        total += d;
        sum[TED4_SUM_N1]  += d * n1;
        sum[TED4_SUM_N2]  += d * n2;
        sum[TED4_SUM_N11] += d * n1 * n1;
        sum[TED4_SUM_N12] += d * n1 * n2;
        sum[TED4_SUM_N22] += d * n2 * n2;
        for (int k = 0; k < 3; k++)
            sum[TED4_SUM_COLOUR + k] += p.w * s->d[k];
    }
    sum8(sum, sums);
    *sum0 = sum1(total);
}

/* Second walk, back to front. */
static void sum_tile(tile_state *tile, const struct ted4_raster *r)
{
    for (uint32_t i = tile->n; i-- > 0;) {
        float *sums = (float *)r->sums.data + (size_t)tile->slot[i] * TED4_GRAD_SUMS, *sum0 = (float *)r->sum0.data + tile->slot[i];

        if (i >= AHEAD) {
            __builtin_prefetch((float *)r->sums.data + (size_t)tile->slot[i - AHEAD] * TED4_GRAD_SUMS, 1);
            __builtin_prefetch((float *)r->sum0.data + tile->slot[i - AHEAD], 1);
        }
        if (tile->mask[i] != 0) {
            sum_splat(&tile->splat[i], tile->mask[i], tile->state, tile->pair, sums, sum0);
        } else {
            memset(sums, 0, TED4_GRAD_SUMS * sizeof *sums);
            *sum0 = 0;
        }
    }
}

/* 0, or -1: no memory. */
static int tile_bwd(bwd_job *job, size_t number, ted4_growing *scratch)
{
    const struct ted4_raster *r = job->r;
    const uint32_t begin = ((const uint32_t *)r->tile_first.data)[number];
    const uint32_t n = ((const uint32_t *)r->tile_first.data)[number + 1] - begin;
    const uint32_t tx = (uint32_t)number % r->tiles_x, ty = (uint32_t)number / r->tiles_x;
    tile_state     tile;

    tile.slot     = (const uint32_t *)r->slot.data + begin;
    tile.reach    = (const ted4_reach *)r->reach.data + ted4_group_first(number, begin);
    tile.n        = n;
    tile.n_groups = (n + TED4_GROUP - 1) / TED4_GROUP;
    if (n == 0)
        return 0;
    if (share_pairs(&tile, r->splat2d.data, (const uint32_t *)r->owner.data + begin, scratch) != 0)
        return -1;
    for (int b = 0; b < TED4_TILE_BLOCKS; b++) {
        ted4_block_pixels(tx, ty, b, &tile.state[b].px, &tile.state[b].py);
        load_block(job, &tile.state[b], tx * TED4_TILE + (size_t)(b % TED4_BLOCK) * TED4_BLOCK,
                   ty * TED4_TILE + (size_t)(b / TED4_BLOCK) * TED4_BLOCK);
        walk_block(&tile, b, job->v);
    }
    sum_tile(&tile, r);
    return 0;
}

/* Takes tiles until none is left: whoever does a tile, it gives the same sums. */
static void bwd_worker(void *arg, size_t worker)
{
    bwd_job     *job = arg;
    const size_t n_tiles = (size_t)job->r->tiles_x * job->r->tiles_y;

    for (size_t tile; (tile = atomic_fetch_add(&job->next_tile, 1)) < n_tiles;)
        if (tile_bwd(job, tile, &job->r->scratch[worker]) != 0)
            atomic_store(&job->failed, 1);
}

int ted4_raster_blend_bwd(struct ted4_raster *r, const ted4_view *v, const ted4_parallel *p, const float *d_image)
{
    bwd_job job = { .r = r, .v = v, .d_image = d_image };

    if (ted4_growing_grow(&r->sums, r->n_instances, TED4_GRAD_SUMS * sizeof(float)) != 0
        || ted4_growing_grow(&r->sum0, r->n_instances, sizeof(float)) != 0)
        return -1;
    atomic_init(&job.next_tile, 0);
    atomic_init(&job.failed, 0);
    ted4_parallel_for(p, TED4_BWD_JOBS, bwd_worker, &job);
    return atomic_load(&job.failed) ? -1 : 0;
}
