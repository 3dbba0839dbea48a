/* blend.c - third stage of raster.c: one job a tile, one vector a block of 4x4 pixels. The tile's list is taken in batches; each batch is
 * copied together (its Gaussians lie on as many pages as they are), and an exact test of ellipse against block says which of them each block
 * needs; then it is blended block by block.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "render/raster_state.h"

enum {
    BATCH_GROUPS = 4,           /* groups of instances between two changes of block; their records fill a third of a level 1 cache */
    BATCH        = BATCH_GROUPS * TED4_GROUP,
    HALF_GROUP   = TED4_GROUP / 2
};

typedef struct {
    struct ted4_raster *r;
    const ted4_view    *v;
    float              *image;
    int                 keep_state;
} blend_job;

typedef struct {
    ted4_vf px, py;
    ted4_vf t;                  /* transmittance; under TED4_RASTER_T_MIN where finished or outside the image */
    ted4_vf t_out;              /* transmittance that the background sees */
    ted4_vf colour[3];
} block_state;

/* Blocks (lanes) of the tile with corner pixel centre (x, y) which the Gaussian may reach. On a box, log2(alpha) is largest at the
 * centre if that is inside, else on one of the two sides that face it; (cx, cy) is the point nearest to the centre, and the candidates
 * are the best points of the lines through it. */
TED4_INLINE ted4_vi reached_blocks(const ted4_splat2d *g, float x, float y)
{
    const ted4_vf col = { 0, 4, 8, 12, 0, 4, 8, 12, 0, 4, 8, 12, 0, 4, 8, 12 };
    const ted4_vf row = { 0, 0, 0, 0, 4, 4, 4, 4, 8, 8, 8, 8, 12, 12, 12, 12 };
    const float   span = TED4_BLOCK - 1;
    const float   slack = 0.01f;        /* of rounding; pixels decide for themselves */
    const ted4_vf x0 = col + (x - g->x), y0 = row + (y - g->y), x1 = x0 + span, y1 = y0 + span;
    const ted4_vf cx = ted4_vf_keep(x0 > 0.0f, x0) + ted4_vf_keep(x1 < 0.0f, x1);
    const ted4_vf cy = ted4_vf_keep(y0 > 0.0f, y0) + ted4_vf_keep(y1 < 0.0f, y1);
    const ted4_vf dx = ted4_vf_max(x0, ted4_vf_min(x1, g->lean_x * cy)), dy = ted4_vf_max(y0, ted4_vf_min(y1, g->lean_y * cx));
    const ted4_vf n1 = g->a1 * dx + g->a2 * cy, n2 = g->a3 * cy;
    const ted4_vf m1 = g->a1 * cx + g->a2 * dy, m2 = g->a3 * dy;
    const float   reach = g->level - TED4_LOG2_ALPHA_MIN + slack;

    return (n1 * n1 + n2 * n2 <= reach) | (m1 * m1 + m2 * m2 <= reach);
}

/* Half a group, n <= HALF_GROUP: bit i of lane b for instance i and block b. near: copies of the instances' Gaussians. */
static ted4_vu reach_half(const ted4_splat2d *splat, const uint32_t *owner, uint32_t n, float x, float y, ted4_splat2d *near)
{
    ted4_vu all = {0}, bit = all + 1u;

    for (uint32_t i = 0; i < n; i++) {
        __builtin_prefetch(&splat[owner[i + TED4_AHEAD]]);
        near[i] = splat[owner[i]];
        all |= (ted4_vu)reached_blocks(&near[i], x, y) & bit;
        bit += bit;
    }
    return all;
}

/* A group, n <= TED4_GROUP. live: all bits set for unfinished blocks, none for others. */
static void reach_group(const ted4_splat2d *splat, const uint32_t *owner, uint32_t n, float x, float y, const uint64_t *live,
                        ted4_splat2d *near, ted4_reach *out)
{
    const uint32_t half = n < HALF_GROUP ? n : HALF_GROUP;
    const ted4_vu  low = reach_half(splat, owner, half, x, y, near);
    const ted4_vu  high = reach_half(splat, owner + half, n - half, x, y, near + half);

    for (int b = 0; b < TED4_TILE_BLOCKS; b++)
        out->block[b] = ((uint64_t)high[b] << HALF_GROUP | low[b]) & live[b];
}

/* Blends the Gaussians that reach says into block b. When every pixel is finished, takes those not needed out of reach; the result is
 * then 0, else 1. */
static int blend_block(block_state *state, int b, const ted4_splat2d *near, ted4_reach *reach, uint32_t n_groups)
{
    block_state s = *state;
    uint32_t    group = 0;
    int         live = 1;

    for (; group < n_groups && live; group++) {
        for (uint64_t rest = reach[group].block[b]; rest != 0; rest &= rest - 1) {
            const ted4_splat2d *g = &near[group * TED4_GROUP + (uint32_t)__builtin_ctzll(rest)];
            ted4_vf alpha, w;

            ted4_blend_step(g, s.px, s.py, &s.t, &alpha, &w);
            s.t_out -= w;
            for (int k = 0; k < 3; k++)
                s.colour[k] += g->colour[k] * w;
        }
        live = ted4_vi_bits(s.t >= TED4_RASTER_T_MIN) != 0;
    }
    for (; group < n_groups; group++)
        reach[group].block[b] = 0;
    *state = s;
    return live;
}

/* live: see reach_group; blocks outside the image are finished from the start. */
static void init_blocks(block_state *state, uint64_t *live, uint32_t tx, uint32_t ty, const ted4_view *v)
{
    for (int b = 0; b < TED4_TILE_BLOCKS; b++) {
        block_state *s = &state[b];

        memset(s, 0, sizeof *s);
        ted4_block_pixels(tx, ty, b, &s->px, &s->py);
        s->t     = ted4_vf_keep((s->px < (float)v->width) & (s->py < (float)v->height), ted4_vf_all(1.0f));
        s->t_out = s->t;
        live[b]  = ted4_vi_bits(s->t > 0.0f) != 0 ? UINT64_MAX : 0;
    }
}

static void store_block(const blend_job *job, const block_state *s, size_t x, size_t y)
{
    const size_t width = (size_t)job->v->width, height = (size_t)job->v->height;

    if (x >= width)
        return;
    const size_t n = width - x < TED4_BLOCK ? width - x : TED4_BLOCK;
    for (size_t k = 0; k < 3; k++) {
        float out[TED4_VEC];

        ted4_vf_store(out, s->colour[k] + job->v->background[k] * s->t_out);
        for (size_t row = 0; row < TED4_BLOCK && y + row < height; row++)
            memcpy(job->image + (k * height + y + row) * width + x, out + row * TED4_BLOCK, n * sizeof *out);
    }
}

/* Blends one batch of n <= BATCH instances; updates live. Returns how many blocks still are. */
static int blend_batch(const blend_job *job, const uint32_t *owner, uint32_t n, uint32_t tx, uint32_t ty, block_state *state,
                       uint64_t *live, ted4_reach *reach)
{
    const ted4_splat2d *splat = job->r->splat2d.data;
    const uint32_t      n_groups = (n + TED4_GROUP - 1) / TED4_GROUP;
    const float         x = (float)(tx * TED4_TILE) + 0.5f, y = (float)(ty * TED4_TILE) + 0.5f;
    ted4_splat2d        near[BATCH];
    int                 n_live = 0;

    for (uint32_t i = 0; i < TED4_AHEAD; i++)
        __builtin_prefetch(&splat[owner[i]]);
    for (uint32_t group = 0; group < n_groups; group++) {
        const uint32_t begin = group * TED4_GROUP, rest = n - begin;

        reach_group(splat, owner + begin, rest < TED4_GROUP ? rest : TED4_GROUP, x, y, live, near + begin, &reach[group]);
    }
    for (int b = 0; b < TED4_TILE_BLOCKS; b++)
        if (live[b] != 0) {
            if (blend_block(&state[b], b, near, reach, n_groups))
                n_live++;
            else
                live[b] = 0;
        }
    return n_live;
}

static void blend_tile(void *arg, size_t tile)
{
    const blend_job *job = arg;
    const uint32_t  *tile_first = job->r->tile_first.data, *owner = job->r->owner.data;
    const uint32_t   tx = (uint32_t)tile % job->r->tiles_x, ty = (uint32_t)tile / job->r->tiles_x;
    const uint32_t   begin = tile_first[tile], n = tile_first[tile + 1] - begin;
    ted4_reach       passing[BATCH_GROUPS];
    ted4_reach      *kept = job->keep_state ? (ted4_reach *)job->r->reach.data + ted4_group_first(tile, begin) : NULL;
    block_state      state[TED4_TILE_BLOCKS];
    uint64_t         live[TED4_TILE_BLOCKS];
    int              n_live = 1;

    init_blocks(state, live, tx, ty, job->v);
    for (uint32_t at = 0; at < n; at += BATCH) {
        const uint32_t size = n - at < BATCH ? n - at : BATCH;
        ted4_reach    *reach = kept != NULL ? kept + at / TED4_GROUP : passing;

        if (n_live != 0)
            n_live = blend_batch(job, owner + begin + at, size, tx, ty, state, live, reach);
        else if (kept != NULL)
            memset(reach, 0, (size + TED4_GROUP - 1) / TED4_GROUP * sizeof *reach);
        else
            break;
    }
    for (int b = 0; b < TED4_TILE_BLOCKS; b++)
        store_block(job, &state[b], tx * TED4_TILE + (size_t)(b % TED4_BLOCK) * TED4_BLOCK,
                    ty * TED4_TILE + (size_t)(b / TED4_BLOCK) * TED4_BLOCK);
}

int ted4_raster_blend(struct ted4_raster *r, const ted4_view *v, const ted4_parallel *p, int keep_state, float *image)
{
    blend_job job = { r, v, image, keep_state };

    const size_t n_tiles = (size_t)r->tiles_x * r->tiles_y;

    if (keep_state && ted4_growing_grow(&r->reach, n_tiles + r->n_instances / TED4_GROUP + 1, sizeof(ted4_reach)) != 0)
        return -1;
    ted4_parallel_for(p, n_tiles, blend_tile, &job);
    return 0;
}
