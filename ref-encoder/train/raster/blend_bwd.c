/* blend_bwd.c - adjoint of render/blend.c, one tile at a time.
 *
 * With T the transmittance before a Gaussian, C the colour of everything behind it as it would look
 * if it were the first, and D the pixel's gradient,
 *     image = ... + T (alpha colour + (1 - alpha) C),   dL/dalpha = T (colour - C) . D,
 *         dL/dcolour = alpha T D,
 * so a walk from back to front needs only C . D as its state:
 *     behind <- behind + alpha (colour . D - behind).
 * There is no division by 1 - alpha, because opacities and weights come from a first walk, from
 * front to back, that repeats the forward pass.
 *
 * The first walk goes block by block, so that T stays in a register; the second goes Gaussian by
 * Gaussian, so that the sums over pixels do.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "adjoint.h"
#include "render/image_model.h"

#include <stdatomic.h>

enum { AHEAD = 8 }; /* instances to prefetch ahead, as they are scattered in memory */

typedef struct {
    ted4_adjoint *a;
    const ted4_raster *r;
    const ted4_view *v;
    const float *d_image;
    atomic_size_t next_tile;
    atomic_int failed;
} bwd_job;

/* A Gaussian, as blended, at the pixels of one part of a block (those that fill one register). */
typedef struct {
    ted4_vf alpha, w;
} blended;

typedef struct {
    ted4_vf px, py;
    ted4_vf d[3];   /* dL / d colour; 0 outside the image */
    ted4_vf behind; /* C . D */
    size_t first,
        end; /* the part's range of the tile's pairs; the second walk moves end to the front */
} part_state;

/* The state of one tile. */
typedef struct {
    ted4_splat2d
        *splat; /* [n] contiguous copies: each original may be on a memory page of its own */
    const uint32_t *instance; /* [n] */
    const ted4_reach *reach;  /* [n_groups] */
    uint32_t n, n_groups;
    blended *pair;  /* all pairs, block after block, part after part */
    uint16_t *mask; /* [n] bit b: the instance has a pair in block b */
    part_state state[TED4_VECS][TED4_TILE_BLOCKS];
} tile_state;

/* Sums over the pixels of a block. The order of additions is the same for every vector size: first
 * pixels i and i + 8, then i and i + 4, then 0 and 2, 1 and 3, and finally these two. */
typedef struct {
    ted4_vf term[TED4_GRAD_SUMS], total;
} part_sums;

typedef float quarter __attribute__((vector_size(16)));

#if TED4_VEC_BYTES == 64
/* The first two steps of the sum, which reduce 16 lanes to 4. */
TED4_INLINE quarter to_quarter(ted4_vf v)
{
    return (TED4_SHUFFLE(v, v, 0, 1, 2, 3) + TED4_SHUFFLE(v, v, 8, 9, 10, 11)) +
           (TED4_SHUFFLE(v, v, 4, 5, 6, 7) + TED4_SHUFFLE(v, v, 12, 13, 14, 15));
}

/* Does the same steps for four sums at once; each quarter of the result belongs to one sum. */
TED4_INLINE ted4_vf to_quarters(const ted4_vf v[4])
{
    ted4_vf half[2];

    for (int i = 0; i < 2; i++) {
        const ted4_vf a = v[2 * i], b = v[2 * i + 1];

        half[i] = TED4_SHUFFLE(a, b, 0, 1, 2, 3, 4, 5, 6, 7, 16, 17, 18, 19, 20, 21, 22, 23) +
                  TED4_SHUFFLE(a, b, 8, 9, 10, 11, 12, 13, 14, 15, 24, 25, 26, 27, 28, 29, 30, 31);
    }
    return TED4_SHUFFLE(half[0], half[1], 0, 1, 2, 3, 8, 9, 10, 11, 16, 17, 18, 19, 24, 25, 26,
                        27) +
           TED4_SHUFFLE(half[0], half[1], 4, 5, 6, 7, 12, 13, 14, 15, 20, 21, 22, 23, 28, 29, 30,
                        31);
}

TED4_INLINE void add_terms(const part_sums *s, float sums[TED4_GRAD_SUMS])
{
    typedef float eight __attribute__((vector_size(32)));
    const ted4_vf p = to_quarters(s->term), q = to_quarters(s->term + 4);
    const ted4_vf two =
        TED4_SHUFFLE(p, q, 0, 1, 16, 17, 4, 5, 20, 21, 8, 9, 24, 25, 12, 13, 28, 29) +
        TED4_SHUFFLE(p, q, 2, 3, 18, 19, 6, 7, 22, 23, 10, 11, 26, 27, 14, 15, 30, 31);
    const eight one = TED4_SHUFFLE(two, two, 0, 4, 8, 12, 2, 6, 10, 14) +
                      TED4_SHUFFLE(two, two, 1, 5, 9, 13, 3, 7, 11, 15);

    memcpy(sums, &one, sizeof one);
}

TED4_INLINE quarter total_quarter(const part_sums *s)
{
    return to_quarter(s->total);
}
#else
/* The first two steps, which reduce 16 lanes to 4, of the sum at offset at (in floats) in the sums
 * of each part. */
TED4_INLINE quarter to_quarter(const part_sums *s, size_t at)
{
#if TED4_VEC_BYTES == 32
    const ted4_vf v = ted4_vf_load((const float *)&s[0] + at) +
                      ted4_vf_load((const float *)&s[1] + at);

    return TED4_SHUFFLE(v, v, 0, 1, 2, 3) + TED4_SHUFFLE(v, v, 4, 5, 6, 7);
#else
    return (ted4_vf_load((const float *)&s[0] + at) + ted4_vf_load((const float *)&s[2] + at)) +
           (ted4_vf_load((const float *)&s[1] + at) + ted4_vf_load((const float *)&s[3] + at));
#endif
}

/* The last two steps, for four sums at once. */
TED4_INLINE void finish_sums(const quarter q[4], float out[4])
{
    const quarter a = TED4_SHUFFLE(q[0], q[1], 0, 1, 4, 5) + TED4_SHUFFLE(q[0], q[1], 2, 3, 6, 7);
    const quarter b = TED4_SHUFFLE(q[2], q[3], 0, 1, 4, 5) + TED4_SHUFFLE(q[2], q[3], 2, 3, 6, 7);
    const quarter e = TED4_SHUFFLE(a, b, 0, 2, 4, 6) + TED4_SHUFFLE(a, b, 1, 3, 5, 7);

    memcpy(out, &e, sizeof e);
}

TED4_INLINE void add_terms(const part_sums *s, float sums[TED4_GRAD_SUMS])
{
    quarter q[TED4_GRAD_SUMS];

    for (size_t i = 0; i < TED4_GRAD_SUMS; i++)
        q[i] = to_quarter(s, i * TED4_VEC);
    finish_sums(q, sums);
    finish_sums(q + 4, sums + 4);
}

TED4_INLINE quarter total_quarter(const part_sums *s)
{
    return to_quarter(s, TED4_GRAD_SUMS * TED4_VEC);
}
#endif

TED4_INLINE void add_parts(const part_sums *s, float sums[TED4_GRAD_SUMS], float *sum0)
{
    const quarter total = total_quarter(s);

    add_terms(s, sums);
    *sum0 = (total[0] + total[2]) + (total[1] + total[3]);
}

static void load_block(const bwd_job *job, tile_state *tile, int b, size_t x, size_t y)
{
    const size_t width = (size_t)job->v->width, height = (size_t)job->v->height;
    const size_t n = x >= width ? 0 : width - x < TED4_BLOCK ? width - x : TED4_BLOCK;

    for (int part = 0; part < TED4_VECS; part++)
        tile->state[part][b].behind = ted4_vf_all(0.0f);
    for (size_t k = 0; k < 3; k++) {
        float d[TED4_LANE_GROUP] = { 0 };

        for (size_t row = 0; row < TED4_BLOCK && y + row < height; row++)
            memcpy(d + row * TED4_BLOCK, job->d_image + (k * height + y + row) * width + x,
                   n * sizeof *d);
        for (int part = 0; part < TED4_VECS; part++) {
            part_state *s = &tile->state[part][b];

            s->d[k] = ted4_vf_load(d + part * TED4_VEC);
            s->behind = ted4_vf_fma(ted4_vf_all(job->v->background[k]), s->d[k], s->behind);
        }
    }
}

/* Assigns each block its range of the pairs, and copies the tile's Gaussians to contiguous memory.
 * Returns 0, or -1 if memory ran out. */
static int share_pairs(tile_state *tile, const ted4_splat2d *splat, const uint32_t *owner,
                       ted4_growing *scratch)
{
    size_t total = 0;

    for (int b = 0; b < TED4_TILE_BLOCKS; b++) {
        size_t n = 0;

        for (uint32_t group = 0; group < tile->n_groups; group++)
            n += (size_t)__builtin_popcountll(tile->reach[group].block[b]);
        for (int part = 0; part < TED4_VECS; part++) {
            tile->state[part][b].first = total;
            total += n;
            tile->state[part][b].end = total;
        }
    }
    if (ted4_growing_grow(scratch, 1,
                          total * sizeof(blended) +
                              tile->n * (sizeof(ted4_splat2d) + sizeof(uint16_t))) != 0)
        return -1;
    tile->pair = scratch->data;
    tile->splat = (ted4_splat2d *)(tile->pair + total);
    tile->mask = (uint16_t *)(tile->splat + tile->n);
    memset(tile->mask, 0, tile->n * sizeof *tile->mask);
    for (uint32_t i = 0; i < tile->n; i++) {
        __builtin_prefetch(&splat[owner[i + TED4_AHEAD]]);
        tile->splat[i] = splat[owner[i]];
    }
    return 0;
}

/* First walk: repeats blend_part of blend.c, and keeps opacities and weights. */
static void walk_part(tile_state *tile, int b, int part, const ted4_view *v)
{
    const part_state *s = &tile->state[part][b];
    const ted4_vf px = s->px, py = s->py;
    ted4_vf t = ted4_vf_keep((px < (float)v->width) & (py < (float)v->height), ted4_vf_all(1.0f));
    blended *pair = tile->pair + s->first;

    for (uint32_t group = 0; group < tile->n_groups; group++)
        for (uint64_t rest = tile->reach[group].block[b]; rest != 0; rest &= rest - 1, pair++) {
            const uint32_t i = group * TED4_GROUP + (uint32_t)__builtin_ctzll(rest);

            ted4_blend_step(&tile->splat[i], px, py, &t, &pair->alpha, &pair->w);
            tile->mask[i] |= (uint16_t)(1u << b);
        }
}

/* Second walk, for one Gaussian of the tile and one part of its blocks: removes the last pair of
 * each block in mask, and sums over their pixels. */
TED4_INLINE void sum_part(const ted4_splat2d *g, uint32_t mask, part_state *state,
                          const blended *pair, part_sums *out)
{
    ted4_vf sum[TED4_GRAD_SUMS] = { { 0 } }, total = { 0 };

    for (uint32_t rest = mask; rest != 0; rest &= rest - 1) {
        part_state *s = &state[__builtin_ctz(rest)];
        const blended p = pair[--s->end];
        const ted4_vf ahead =
            ted4_vf_fma(ted4_vf_all(g->colour[0]), s->d[0],
                        ted4_vf_fma(ted4_vf_all(g->colour[1]), s->d[1],
                                    ted4_vf_fma(ted4_vf_all(g->colour[2]), s->d[2], -s->behind)));
        /* alpha = min(cap, o exp(-e)): d alpha / d ln(o exp(-e)) is alpha, or 0 where capped */
        const ted4_vf d = ted4_vf_keep(p.alpha < TED4_RASTER_ALPHA_MAX, p.w * ahead);
        const ted4_vf dx = s->px - g->x, dy = s->py - g->y;
        const ted4_vf n1 = ted4_vf_fma(ted4_vf_all(g->a1), dx, g->a2 * dy), n2 = g->a3 * dy;
        const ted4_vf d1 = d * n1, d2 = d * n2;

        s->behind = ted4_vf_fma(p.alpha, ahead, s->behind);
        total += d;
        sum[TED4_SUM_N1] += d1;
        sum[TED4_SUM_N2] += d2;
        sum[TED4_SUM_N11] = ted4_vf_fma(d1, n1, sum[TED4_SUM_N11]);
        sum[TED4_SUM_N12] = ted4_vf_fma(d1, n2, sum[TED4_SUM_N12]);
        sum[TED4_SUM_N22] = ted4_vf_fma(d2, n2, sum[TED4_SUM_N22]);
        for (int k = 0; k < 3; k++)
            sum[TED4_SUM_COLOUR + k] = ted4_vf_fma(p.w, s->d[k], sum[TED4_SUM_COLOUR + k]);
    }
    memcpy(out->term, sum, sizeof sum);
    out->total = total;
}

/* Second walk, back to front. */
static void sum_tile(tile_state *tile, const ted4_adjoint *a)
{
    for (uint32_t i = tile->n; i-- > 0;) {
        float *sums = (float *)a->sums.data + (size_t)tile->instance[i] * TED4_GRAD_SUMS,
              *sum0 = (float *)a->sum0.data + tile->instance[i];

        if (i >= AHEAD) {
            __builtin_prefetch(
                (float *)a->sums.data + (size_t)tile->instance[i - AHEAD] * TED4_GRAD_SUMS, 1);
            __builtin_prefetch((float *)a->sum0.data + tile->instance[i - AHEAD], 1);
        }
        if (tile->mask[i] != 0) {
            part_sums part[TED4_VECS];

            for (int k = 0; k < TED4_VECS; k++)
                sum_part(&tile->splat[i], tile->mask[i], tile->state[k], tile->pair, &part[k]);
            add_parts(part, sums, sum0);
        } else {
            memset(sums, 0, TED4_GRAD_SUMS * sizeof *sums);
            *sum0 = 0;
        }
    }
}

/* Returns 0, or -1 if memory ran out. */
static int tile_bwd(bwd_job *job, size_t number, ted4_growing *scratch)
{
    const struct ted4_raster *r = job->r;
    const uint32_t begin = ((const uint32_t *)r->tile_first.data)[number];
    const uint32_t n = ((const uint32_t *)r->tile_first.data)[number + 1] - begin;
    const uint32_t tx = (uint32_t)number % r->tiles_x, ty = (uint32_t)number / r->tiles_x;
    tile_state tile;

    tile.instance = (const uint32_t *)r->instance.data + begin;
    tile.reach = (const ted4_reach *)r->reach.data + ted4_group_first(number, begin);
    tile.n = n;
    tile.n_groups = (n + TED4_GROUP - 1) / TED4_GROUP;
    if (n == 0)
        return 0;
    if (share_pairs(&tile, r->splat2d.data, (const uint32_t *)r->owner.data + begin, scratch) != 0)
        return -1;
    for (int b = 0; b < TED4_TILE_BLOCKS; b++) {
        load_block(job, &tile, b, tx * TED4_TILE + (size_t)(b % TED4_BLOCK) * TED4_BLOCK,
                   ty * TED4_TILE + (size_t)(b / TED4_BLOCK) * TED4_BLOCK);
        for (int part = 0; part < TED4_VECS; part++) {
            part_state *s = &tile.state[part][b];

            ted4_block_pixels(tx, ty, b, part, &s->px, &s->py);
            walk_part(&tile, b, part, job->v);
        }
    }
    sum_tile(&tile, job->a);
    return 0;
}

/* Processes tiles until none is left. The sums of a tile do not depend on the worker. */
static void bwd_worker(void *arg, size_t worker)
{
    bwd_job *job = arg;
    const size_t n_tiles = (size_t)job->r->tiles_x * job->r->tiles_y;

    for (size_t tile; (tile = atomic_fetch_add(&job->next_tile, 1)) < n_tiles;)
        if (tile_bwd(job, tile, &job->a->scratch[worker]) != 0)
            atomic_store(&job->failed, 1);
}

int TED4_LEVELED(ted4_raster_blend_bwd)(ted4_adjoint *a, const ted4_raster *r, const ted4_view *v,
                                        const ted4_parallel *p, const float *d_image)
{
    bwd_job job = { .a = a, .r = r, .v = v, .d_image = d_image };

    if (ted4_growing_grow(&a->sums, r->n_instances, TED4_GRAD_SUMS * sizeof(float)) != 0 ||
        ted4_growing_grow(&a->sum0, r->n_instances, sizeof(float)) != 0)
        return -1;
    atomic_init(&job.next_tile, 0);
    atomic_init(&job.failed, 0);
    ted4_parallel_for(p, TED4_BWD_JOBS, bwd_worker, &job);
    return atomic_load(&job.failed) ? -1 : 0;
}
