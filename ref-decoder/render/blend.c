/* blend.c - third stage of raster.c: one job a tile, one vector a block of 4x4 pixels. The tile's list is taken in batches; each batch is first
 * split into one list a block, by an exact test of ellipse against block, then blended block by block. Used by raster.c.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "render/raster_state.h"

enum {
    BATCH       = 256,          /* instances; their records fill a third of a level 1 cache */
    CHECK_EVERY = 8             /* Gaussians between two questions whether a block is finished */
};

typedef struct {
    struct ted4_raster *r;
    const ted4_view    *v;
    float              *image;
    int                 keep_state;
} blend_job;

typedef struct {
    ted4_vf px, py;
    ted4_vf t;                  /* transmittance, 0 once finished or outside the image */
    ted4_vf t_out;              /* transmittance that the background sees */
    ted4_vf colour[3];
} block_state;

/* Whom each block of a tile has to blend, of one batch. */
typedef struct {
    uint32_t n[TED4_TILE_BLOCKS];
    uint16_t item[TED4_TILE_BLOCKS][BATCH];     /* index within the batch */
} block_lists;

/* Blocks of the tile with corner pixel centre (x, y) which the Gaussian may reach: bit b for block b. On a box, log2(alpha) is largest at the
 * centre if that is inside, else on one of the two sides that face it; (cx, cy) is the point nearest to the centre, and the candidates
 * are the best points of the lines through it. */
static inline uint32_t reached_blocks(const ted4_splat2d *g, float x, float y)
{
    const ted4_vf col = { 0, 4, 8, 12, 0, 4, 8, 12, 0, 4, 8, 12, 0, 4, 8, 12 };
    const ted4_vf row = { 0, 0, 0, 0, 4, 4, 4, 4, 8, 8, 8, 8, 12, 12, 12, 12 };
    const float   span = TED4_BLOCK - 1;
    const float   slack = 0.01f;        /* of rounding; pixels decide for themselves */
    const ted4_vf x0 = col + (x - g->x), y0 = row + (y - g->y), x1 = x0 + span, y1 = y0 + span;
    const ted4_vf zero = {0};
    const ted4_vf cx = ted4_vf_max(x0, ted4_vf_min(x1, zero)), cy = ted4_vf_max(y0, ted4_vf_min(y1, zero));
    const ted4_vf dx = ted4_vf_max(x0, ted4_vf_min(x1, g->lean_x * cy)), dy = ted4_vf_max(y0, ted4_vf_min(y1, g->lean_y * cx));
    const ted4_vf n1 = g->a1 * dx + g->a2 * cy, n2 = g->a3 * cy;
    const ted4_vf m1 = g->a1 * cx + g->a2 * dy, m2 = g->a3 * dy;
    const float   reach = g->level - TED4_LOG2_ALPHA_MIN + slack;

    return ted4_vi_bits((n1 * n1 + n2 * n2 <= reach) | (m1 * m1 + m2 * m2 <= reach));
}

/* Lists a batch per block and, if mask is not NULL, notes who is listed where. live: bits of unfinished blocks. */
static void list_batch(const ted4_splat2d *splat, const uint32_t *owner, uint32_t n, float x, float y, uint32_t live,
                       block_lists *lists, uint16_t *mask)
{
    memset(lists->n, 0, sizeof lists->n);
    for (uint32_t i = 0; i < n; i++) {
        const uint32_t reached = reached_blocks(&splat[owner[i]], x, y) & live;

        for (uint32_t rest = reached; rest != 0; rest &= rest - 1) {
            const int b = __builtin_ctz(rest);
            lists->item[b][lists->n[b]++] = (uint16_t)i;
        }
        if (mask != NULL)
            mask[i] = (uint16_t)reached;
    }
}

/* Returns how many of the list were blended before every pixel of the block was finished. */
static uint32_t blend_block(block_state *state, const ted4_splat2d *splat, const uint32_t *owner, const uint16_t *item, uint32_t n)
{
    block_state s = *state;
    uint32_t    i = 0;

    while (i < n) {
        const uint32_t stop = i + CHECK_EVERY < n ? i + CHECK_EVERY : n;

        for (; i < stop; i++) {
            const ted4_splat2d *g = &splat[owner[item[i]]];
            ted4_vf alpha, w;
            const ted4_vi on = ted4_blend_step(g, s.px, s.py, &s.t, &alpha, &w);

            s.t_out = ted4_vf_select(on, s.t, s.t_out);
            for (int k = 0; k < 3; k++)
                s.colour[k] += g->colour[k] * w;
        }
        if (ted4_vi_bits(s.t > 0.0f) == 0)
            break;
    }
    *state = s;
    return i;
}

/* Returns which blocks have pixels in the image. */
static uint32_t init_blocks(block_state *state, uint32_t tx, uint32_t ty, const ted4_view *v)
{
    uint32_t live = 0;

    for (int b = 0; b < TED4_TILE_BLOCKS; b++) {
        block_state *s = &state[b];

        memset(s, 0, sizeof *s);
        ted4_block_pixels(tx, ty, b, &s->px, &s->py);
        s->t     = ted4_vf_keep((s->px < (float)v->width) & (s->py < (float)v->height), ted4_vf_all(1.0f));
        s->t_out = s->t;
        live |= (uint32_t)(ted4_vi_bits(s->t > 0.0f) != 0) << b;
    }
    return live;
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

/* Blends one batch; clears finished blocks from *live. mask: NULL, or cut down to what was blended. */
static void blend_batch(const blend_job *job, const uint32_t *owner, uint32_t n, uint32_t tx, uint32_t ty, block_state *state,
                        uint32_t *live, uint16_t *mask)
{
    const ted4_splat2d *splat = job->r->splat2d.data;
    block_lists         lists;

    list_batch(splat, owner, n, (float)(tx * TED4_TILE) + 0.5f, (float)(ty * TED4_TILE) + 0.5f, *live, &lists, mask);
    for (uint32_t b = 0; b < TED4_TILE_BLOCKS; b++) {
        const uint32_t done = blend_block(&state[b], splat, owner, lists.item[b], lists.n[b]);

        if (ted4_vi_bits(state[b].t > 0.0f) == 0)
            *live &= ~(1u << b);
        if (mask != NULL)
            for (uint32_t i = done; i < lists.n[b]; i++)
                mask[lists.item[b][i]] &= (uint16_t)~(1u << b);
    }
}

static void blend_tile(void *arg, size_t tile)
{
    const blend_job *job = arg;
    const uint32_t  *tile_first = job->r->tile_first.data, *owner = job->r->owner.data;
    const uint32_t   tx = (uint32_t)tile % job->r->tiles_x, ty = (uint32_t)tile / job->r->tiles_x;
    uint16_t        *mask = job->keep_state ? job->r->mask.data : NULL;
    block_state      state[TED4_TILE_BLOCKS];
    uint32_t         live = init_blocks(state, tx, ty, job->v), at = tile_first[tile];
    const uint32_t   end = tile_first[tile + 1];

    while (at < end && live != 0) {
        const uint32_t n = end - at < BATCH ? end - at : BATCH;

        blend_batch(job, owner + at, n, tx, ty, state, &live, mask != NULL ? mask + at : NULL);
        at += n;
    }
    if (mask != NULL && at < end)
        memset(mask + at, 0, (end - at) * sizeof *mask);
    for (int b = 0; b < TED4_TILE_BLOCKS; b++)
        store_block(job, &state[b], tx * TED4_TILE + (size_t)(b % TED4_BLOCK) * TED4_BLOCK,
                    ty * TED4_TILE + (size_t)(b / TED4_BLOCK) * TED4_BLOCK);
}

int ted4_raster_blend(struct ted4_raster *r, const ted4_view *v, const ted4_parallel *p, int keep_state, float *image)
{
    blend_job job = { r, v, image, keep_state };

    if (keep_state && ted4_buffer_grow(&r->mask, r->n_instances, sizeof(uint16_t)) != 0)
        return -1;
    ted4_parallel_for(p, (size_t)r->tiles_x * r->tiles_y, blend_tile, &job);
    return 0;
}
