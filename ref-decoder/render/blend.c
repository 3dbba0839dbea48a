/* blend.c - the third stage of raster.c: blends Gaussians, with one job per tile and one lane group
 * per block of 4x4 pixels. The list of a tile is processed in batches. The Gaussians of a batch are
 * copied into contiguous memory, since each may lie on a page of its own; an exact test of ellipse
 * against block finds the Gaussians that each block needs; then the batch is blended block by
 * block.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "render/image_model.h"

enum {
    BATCH_GROUPS = 4, /* groups of instances per batch; their records fill a third of a level 1
                         cache */
    BATCH = BATCH_GROUPS * TED4_GROUP,
    HALF_GROUP = TED4_GROUP / 2
};

typedef struct {
    struct ted4_raster *r;
    const ted4_view *v;
    float *image;
    int keep_state;
} blend_job;

/* The state of one register of a block's pixels. */
typedef struct {
    ted4_vf px, py;
    ted4_vf t;     /* transmittance; below TED4_RASTER_T_MIN if finished or outside the image */
    ted4_vf t_out; /* transmittance by which the background is multiplied */
    ted4_vf colour[3];
} part_state;

typedef struct {
    part_state part[TED4_VECS];
} block_state;

/* Returns a mask of the blocks (one per lane) that the Gaussian may reach in part part of the tile
 * whose first pixel centre is (x, y). On a box, log2(alpha) is largest at the Gaussian's centre if
 * that lies inside, else on one of the two sides that face the centre. (cx, cy) is the point of the
 * box nearest to the centre; the candidates are the points of highest alpha on the two lines
 * through it. */
TED4_INLINE ted4_vi reached_blocks(const ted4_splat2d *g, float x, float y, int part)
{
    static const float col[TED4_LANE_GROUP] = {
        0, 4, 8, 12, 0, 4, 8, 12, 0, 4, 8, 12, 0, 4, 8, 12
    };
    static const float row[TED4_LANE_GROUP] = {
        0, 0, 0, 0, 4, 4, 4, 4, 8, 8, 8, 8, 12, 12, 12, 12
    };
    const float span = TED4_BLOCK - 1;
    const float slack = 0.01f; /* for rounding; blending itself tests each pixel exactly */
    const ted4_vf zero = { 0 };
    const ted4_vf x0 = ted4_vf_load(col + part * TED4_VEC) + (x - g->x), x1 = x0 + span;
    const ted4_vf y0 = ted4_vf_load(row + part * TED4_VEC) + (y - g->y), y1 = y0 + span;
    const ted4_vf cx = ted4_vf_max(x0, zero) + ted4_vf_min(x1, zero),
                  cy = ted4_vf_max(y0, zero) + ted4_vf_min(y1, zero);
    const ted4_vf dx = ted4_vf_max(x0, ted4_vf_min(x1, g->lean_x * cy)),
                  dy = ted4_vf_max(y0, ted4_vf_min(y1, g->lean_y * cx));
    const ted4_vf a1 = ted4_vf_all(g->a1);
    const ted4_vf n1 = ted4_vf_fma(a1, dx, g->a2 * cy), n2 = g->a3 * cy;
    const ted4_vf m1 = ted4_vf_fma(a1, cx, g->a2 * dy), m2 = g->a3 * dy;
    const float reach = g->level - TED4_LOG2_ALPHA_MIN + slack;
    const ted4_vf n = ted4_vf_fma(n1, n1, n2 * n2), m = ted4_vf_fma(m1, m1, m2 * m2);

    return ted4_vf_min(n, m) <= reach;
}

/* Tests half a group, n <= HALF_GROUP instances. Bit i of all[b] is set if instance i may reach
 * block b. near[i] gets a copy of the Gaussian of instance i. */
static void reach_half(const ted4_splat2d *splat, const uint32_t *owner, uint32_t n, float x,
                       float y, ted4_splat2d *near, uint32_t all[TED4_TILE_BLOCKS])
{
    ted4_vu sum[TED4_VECS] = { { 0 } }, bit = sum[0] + 1u;

    for (uint32_t i = 0; i < n; i++) {
        __builtin_prefetch(&splat[owner[i + TED4_AHEAD]]);
        near[i] = splat[owner[i]];
        for (int part = 0; part < TED4_VECS; part++)
            sum[part] |= (ted4_vu)reached_blocks(&near[i], x, y, part) & bit;
        bit += bit;
    }
    memcpy(all, sum, sizeof sum);
}

/* Tests a group, n <= TED4_GROUP instances. live has all bits set for unfinished blocks, and none
 * for finished ones. */
static void reach_group(const ted4_splat2d *splat, const uint32_t *owner, uint32_t n, float x,
                        float y, const uint64_t *live, ted4_splat2d *near, ted4_reach *out)
{
    const uint32_t half = n < HALF_GROUP ? n : HALF_GROUP;
    uint32_t low[TED4_TILE_BLOCKS], high[TED4_TILE_BLOCKS];

    reach_half(splat, owner, half, x, y, near, low);
    reach_half(splat, owner + half, n - half, x, y, near + half, high);
    for (int b = 0; b < TED4_TILE_BLOCKS; b++)
        out->block[b] = ((uint64_t)high[b] << HALF_GROUP | low[b]) & live[b];
}

/* Blends the Gaussians of block b in reach into one part of the block. Returns the number of the
 * first group that the part does not need because all its pixels are finished, or n_groups + 1 if
 * they are not all finished. */
static uint32_t blend_part(part_state *state, int b, const ted4_splat2d *near,
                           const ted4_reach *reach, uint32_t n_groups)
{
    part_state s = *state;
    uint32_t group = 0;
    int live = ted4_vi_bits(s.t >= TED4_RASTER_T_MIN) != 0;

    for (; group < n_groups && live; group++) {
        for (uint64_t rest = reach[group].block[b]; rest != 0; rest &= rest - 1) {
            const ted4_splat2d *g = &near[group * TED4_GROUP + (uint32_t)__builtin_ctzll(rest)];
            ted4_vf alpha, w;

            ted4_blend_step(g, s.px, s.py, &s.t, &alpha, &w);
            s.t_out -= w;
            for (int k = 0; k < 3; k++)
                s.colour[k] = ted4_vf_fma(ted4_vf_all(g->colour[k]), w, s.colour[k]);
        }
        live = ted4_vi_bits(s.t >= TED4_RASTER_T_MIN) != 0;
    }
    *state = s;
    return live ? n_groups + 1 : group;
}

/* Blends the Gaussians of block b in reach. Returns 0 if every pixel is finished, with the
 * Gaussians that were not needed removed from reach, else 1. */
static int blend_block(block_state *state, int b, const ted4_splat2d *near, ted4_reach *reach,
                       uint32_t n_groups)
{
    uint32_t end = 0;

    for (int part = 0; part < TED4_VECS; part++) {
        const uint32_t at = blend_part(&state->part[part], b, near, reach, n_groups);

        end = at > end ? at : end;
    }
    for (uint32_t group = end; group < n_groups; group++)
        reach[group].block[b] = 0;
    return end > n_groups;
}

/* Initialises the blocks of a tile and live (see reach_group). Blocks outside the image are
 * finished from the start. */
static void init_blocks(block_state *state, uint64_t *live, uint32_t tx, uint32_t ty,
                        const ted4_view *v)
{
    memset(state, 0, TED4_TILE_BLOCKS * sizeof *state);
    for (int b = 0; b < TED4_TILE_BLOCKS; b++) {
        live[b] = 0;
        for (int part = 0; part < TED4_VECS; part++) {
            part_state *s = &state[b].part[part];

            ted4_block_pixels(tx, ty, b, part, &s->px, &s->py);
            s->t = ted4_vf_keep((s->px < (float)v->width) & (s->py < (float)v->height),
                                ted4_vf_all(1.0f));
            s->t_out = s->t;
            if (ted4_vi_bits(s->t > 0.0f) != 0)
                live[b] = UINT64_MAX;
        }
    }
}

static void store_block(const blend_job *job, const block_state *s, size_t x, size_t y)
{
    const size_t width = (size_t)job->v->width, height = (size_t)job->v->height;

    if (x >= width)
        return;
    const size_t n = width - x < TED4_BLOCK ? width - x : TED4_BLOCK;
    for (size_t k = 0; k < 3; k++) {
        float out[TED4_LANE_GROUP];

        for (int part = 0; part < TED4_VECS; part++)
            ted4_vf_store(out + part * TED4_VEC,
                          ted4_vf_fma(ted4_vf_all(job->v->background[k]), s->part[part].t_out,
                                      s->part[part].colour[k]));
        for (size_t row = 0; row < TED4_BLOCK && y + row < height; row++)
            memcpy(job->image + (k * height + y + row) * width + x, out + row * TED4_BLOCK,
                   n * sizeof *out);
    }
}

/* Blends one batch of n <= BATCH instances and updates live. Returns the number of blocks that are
 * not finished. */
static int blend_batch(const blend_job *job, const uint32_t *owner, uint32_t n, uint32_t tx,
                       uint32_t ty, block_state *state, uint64_t *live, ted4_reach *reach)
{
    const ted4_splat2d *splat = job->r->splat2d.data;
    const uint32_t n_groups = (n + TED4_GROUP - 1) / TED4_GROUP;
    const float x = (float)(tx * TED4_TILE) + 0.5f, y = (float)(ty * TED4_TILE) + 0.5f;
    ted4_splat2d near[BATCH];
    int n_live = 0;

    for (uint32_t i = 0; i < TED4_AHEAD; i++)
        __builtin_prefetch(&splat[owner[i]]);
    for (uint32_t group = 0; group < n_groups; group++) {
        const uint32_t begin = group * TED4_GROUP, rest = n - begin;

        reach_group(splat, owner + begin, rest < TED4_GROUP ? rest : TED4_GROUP, x, y, live,
                    near + begin, &reach[group]);
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
    const uint32_t *tile_first = job->r->tile_first.data, *owner = job->r->owner.data;
    const uint32_t tx = (uint32_t)tile % job->r->tiles_x, ty = (uint32_t)tile / job->r->tiles_x;
    const uint32_t begin = tile_first[tile], n = tile_first[tile + 1] - begin;
    ted4_reach passing[BATCH_GROUPS];
    ted4_reach *kept =
        job->keep_state ? (ted4_reach *)job->r->reach.data + ted4_group_first(tile, begin) : NULL;
    block_state state[TED4_TILE_BLOCKS];
    uint64_t live[TED4_TILE_BLOCKS];
    int n_live = 1;

    init_blocks(state, live, tx, ty, job->v);
    for (uint32_t at = 0; at < n; at += BATCH) {
        const uint32_t size = n - at < BATCH ? n - at : BATCH;
        ted4_reach *reach = kept != NULL ? kept + at / TED4_GROUP : passing;

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

int TED4_LEVELED(ted4_raster_blend)(struct ted4_raster *r, const ted4_view *v,
                                    const ted4_parallel *p, int keep_state, float *image)
{
    blend_job job = { r, v, image, keep_state };

    const size_t n_tiles = (size_t)r->tiles_x * r->tiles_y;

    if (keep_state && ted4_growing_grow(&r->reach, n_tiles + r->n_instances / TED4_GROUP + 1,
                                        sizeof(ted4_reach)) != 0)
        return -1;
    ted4_parallel_for(p, n_tiles, blend_tile, &job);
    return 0;
}
