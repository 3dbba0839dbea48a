/* visible_blocks.c - finds the visible blocks of a view: see visible_blocks.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "visible_blocks.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "train/math/random.h"
#include "train/model/formulas.h"

/* An anchor is treated as a ball whose radius is three times its offset scale, and is visible if
 * the ball intersects the guarded frustum. If things move, the canonical position is less certain,
 * so a tenth of the scene's half-size is added to the radius. */
#define SCALES_OF_BALL 3.0f
#define MOTION_MARGIN  0.1f

/* Gathers flags, each 0 or 1, in the bits of a mask. */
static uint32_t lane_bits(const int32_t *flag)
{
    uint32_t bits = 0;

    for (int j = 0; j < TED4_LANES; j++)
        bits |= (uint32_t)flag[j] << j;
    return bits;
}

uint32_t ted4_block_visible(const ted4_trainer *t, size_t block, const ted4_view *v)
{
    const ted4_layout *l = &t->layout;
    const float *p = ted4_block(&t->anchors, TED4_ROW_POSITION, block);
    const float *s = ted4_block(&t->anchors, TED4_ROW_VALUE, block) +
                     l->first[TED4_SCALING] * TED4_LANES;
    const int is_log2 = l->head.scale_domain == TED4_SCALE_LOG2;
    const float margin = l->head.motion != TED4_MOTION_NONE ? MOTION_MARGIN : 0.0f;
    const float left = TED4_RASTER_GUARD * v->cx / v->fx;
    const float right = TED4_RASTER_GUARD * ((float)v->width - v->cx) / v->fx;
    const float up = TED4_RASTER_GUARD * v->cy / v->fy;
    const float down = TED4_RASTER_GUARD * ((float)v->height - v->cy) / v->fy;
    float widest[TED4_LANES];
    int32_t in_view[TED4_LANES];

#pragma omp simd
    for (int j = 0; j < TED4_LANES; j++) {
        const float a = s[j], b = s[TED4_LANES + j], c = s[2 * TED4_LANES + j];
        const float ab = b > a || a != a ? b : a, most = c > ab || ab != ab ? c : ab;

        widest[j] = is_log2 ? ted4_pow2(most) : most;
    }
#pragma omp simd
    for (int j = 0; j < TED4_LANES; j++) {
        const float x = p[j], y = p[TED4_LANES + j], z = p[2 * TED4_LANES + j];
        const float cx = v->R[0] * x + v->R[1] * y + v->R[2] * z + v->t[0];
        const float cy = v->R[3] * x + v->R[4] * y + v->R[5] * z + v->t[1];
        const float cz = v->R[6] * x + v->R[7] * y + v->R[8] * z + v->t[2];
        const float ball = SCALES_OF_BALL * widest[j] + margin;
        const float depth = cz > v->near_z ? cz : v->near_z;

        in_view[j] = (cz + ball > v->near_z) & (cx < right * depth + ball) &
                     (-cx < left * depth + ball) & (cy < down * depth + ball) &
                     (-cy < up * depth + ball);
    }
    return lane_bits(in_view) & ted4_block_lanes(&t->anchors, block);
}

static int reserve(ted4_trainer *t, size_t n)
{
    ted4_visible_blocks *s = &t->visible_blocks;
    const size_t floats = (size_t)t->layout.n_channels * TED4_LANES;

    if (n <= s->capacity)
        return 0;
    ted4_visible_blocks_finish(s);
    n += n / 2 + 8;
    s->block = malloc(n * sizeof *s->block);
    s->lanes = malloc(n * sizeof *s->lanes);
    s->seen = malloc(n * sizeof *s->seen);
    s->sleeps = malloc(n * sizeof *s->sleeps);
    s->drawn = malloc(n * sizeof *s->drawn);
    s->position = malloc(n * sizeof *s->position);
    s->raw = malloc(n * sizeof *s->raw);
    s->used = malloc(n * sizeof *s->used);
    s->gradient = malloc(n * sizeof *s->gradient);
    s->steps = malloc(n * sizeof *s->steps);
    s->quantised = aligned_alloc(64, n * floats * sizeof(float));
    s->gradients = aligned_alloc(64, n * floats * sizeof(float));
    s->squares = malloc(n * (TED4_BLOCK_TERMS + 1) * sizeof *s->squares);
    if (s->block == NULL || s->lanes == NULL || s->seen == NULL || s->sleeps == NULL ||
        s->drawn == NULL || s->position == NULL || s->raw == NULL || s->used == NULL ||
        s->gradient == NULL || s->steps == NULL || s->quantised == NULL || s->gradients == NULL ||
        s->squares == NULL)
        return ted4_trainer_fail(t, "no memory for %zu blocks", n);
    s->capacity = n;
    return 0;
}

ted4_rate_input ted4_visible_blocks_rate(const ted4_trainer *t)
{
    const ted4_visible_blocks *s = &t->visible_blocks;

    return (ted4_rate_input) { .layout = &t->layout,
                               .net = t->net.value,
                               .shift = t->net.shift,
                               .n_visible = s->n,
                               .attr = s->raw,
                               .position = s->position,
                               .lanes = s->lanes,
                               .block = s->block,
                               .quant = TED4_QUANT_INTEGER,
                               .activation = t->layout.head.activation };
}

void ted4_visible_blocks_finish(ted4_visible_blocks *s)
{
    free(s->block);
    free(s->lanes);
    free(s->seen);
    free(s->sleeps);
    free(s->drawn);
    free(s->position);
    free(s->raw);
    free(s->used);
    free(s->gradient);
    free(s->steps);
    free(s->quantised);
    free(s->gradients);
    free(s->squares);
    memset(s, 0, sizeof *s);
}

/* Blocks that one job tests. */
enum { LOOKED_AT = 8 };

typedef struct {
    const ted4_trainer *t;
    const ted4_view *v; /* [n_views] */
    size_t n_views;
    uint32_t *lanes; /* [n_blocks] */
} visible_job;

static void look_at_blocks(void *arg, size_t i)
{
    const visible_job *j = arg;
    const ted4_anchors *a = &j->t->anchors;
    const size_t end = (i + 1) * LOOKED_AT < a->n_blocks ? (i + 1) * LOOKED_AT : a->n_blocks;

    for (size_t b = i * LOOKED_AT; b < end; b++) {
        j->lanes[b] = j->n_views == 0 ? ted4_block_lanes(a, b) : 0;
        for (size_t k = 0; k < j->n_views; k++)
            j->lanes[b] |= ted4_block_visible(j->t, b, j->v + k);
    }
}

int ted4_visible_blocks_fill(ted4_trainer *t, const ted4_view *v)
{
    return ted4_visible_blocks_of(t, v, v != NULL);
}

int ted4_visible_blocks_of(ted4_trainer *t, const ted4_view *v, size_t n)
{
    ted4_visible_blocks *s = &t->visible_blocks;
    const size_t floats = (size_t)t->layout.n_channels * TED4_LANES;

    if (reserve(t, t->anchors.n_blocks) != 0)
        return -1;

    /* The lanes of all blocks are computed first, in place, because the index of a visible block is
     * known only then. That index is at most the number of the block. */
    visible_job j = { t, v, n, s->lanes };

    ted4_parallel_for(t->parallel, (t->anchors.n_blocks + LOOKED_AT - 1) / LOOKED_AT,
                      look_at_blocks, &j);
    s->n = 0;
    for (size_t b = 0; b < t->anchors.n_blocks; b++) {
        const uint32_t lanes = s->lanes[b];
        const size_t i = s->n;

        if (lanes == 0)
            continue;
        s->block[i] = (uint32_t)b;
        s->lanes[i] = lanes;
        s->drawn[i] = (uint32_t)i;
        s->position[i] = ted4_block(&t->anchors, TED4_ROW_POSITION, b);
        s->raw[i] = ted4_block(&t->anchors, TED4_ROW_VALUE, b);
        s->used[i] = t->phase.stage2 ? s->quantised + i * floats : s->raw[i];
        s->gradient[i] = s->gradients + i * floats;
        s->steps[i] = ted4_block(&t->anchors, TED4_ROW_STEP, b);
        s->n++;
    }
    s->awake = s->n;
    return 0;
}

typedef struct {
    const ted4_trainer *t;
    uint64_t key;
    ted4_quant quant;
} quantise_job;

static void quantise_block(void *arg, size_t i)
{
    const quantise_job *j = arg;
    const ted4_visible_blocks *s = &j->t->visible_blocks;
    const size_t floats = (size_t)j->t->layout.n_channels * TED4_LANES;

    ted4_quantise(&j->t->layout, j->quant, s->raw[i], s->steps[i], s->block[i], j->key,
                  s->quantised + i * floats);
}

void ted4_visible_blocks_quantise(ted4_trainer *t, ted4_quant quant)
{
    quantise_job j = { t, ted4_random(t->opt.seed, t->iteration), quant };

    if (t->phase.stage2)
        ted4_parallel_for(t->parallel, t->visible_blocks.n, quantise_block, &j);
}

/* An anchor with less activation is not drawn, because no opacity exceeds 1. The rasteriser's limit
 * is a little lowered, as its arithmetic is another one. */
#define LEAST_ACTIVATION (0.99f * TED4_RASTER_ALPHA_MIN)

typedef struct {
    const ted4_visible_blocks *s;
    float now;
    size_t tau; /* floats before the activation in a block */
} wake_job;

/* A time is within a life that is not a number (ted4_find_edge), so that the monitor sees it. */
static void look_at_life(void *arg, size_t i)
{
    const wake_job *w = arg;
    const float *tau = w->s->used[i] + w->tau;
    int32_t there[TED4_LANES];

#pragma omp simd
    for (int j = 0; j < TED4_LANES; j++) {
        const float u = ted4_find_edge(w->now, tau + j, ted4_pow2).u;

        there[j] = ted4_activation(u, ted4_pow2) >= LEAST_ACTIVATION;
    }
    w->s->sleeps[i] = !(lane_bits(there) & w->s->lanes[i]);
}

/* Exchanges visible blocks i and k, without what belongs to places in the list. */
static void exchange(ted4_visible_blocks *s, size_t i, size_t k)
{
    const uint32_t block = s->block[i], lanes = s->lanes[i];
    const float *position = s->position[i], *raw = s->raw[i], *used = s->used[i];
    float *steps = s->steps[i];

    s->block[i] = s->block[k];
    s->lanes[i] = s->lanes[k];
    s->position[i] = s->position[k];
    s->raw[i] = s->raw[k];
    s->used[i] = s->used[k];
    s->steps[i] = s->steps[k];
    s->block[k] = block;
    s->lanes[k] = lanes;
    s->position[k] = position;
    s->raw[k] = raw;
    s->used[k] = used;
    s->steps[k] = steps;
}

void ted4_visible_blocks_wake(ted4_trainer *t, const ted4_generate_input *in)
{
    ted4_visible_blocks *s = &t->visible_blocks;
    wake_job w = { s, (float)in->num / (float)in->den, 0 };

    s->awake = s->n;
    if (!in->activation)
        return;
    w.tau = (size_t)t->layout.first[TED4_TAU] * TED4_LANES;
    ted4_parallel_for(t->parallel, s->n, look_at_life, &w);
    s->awake = 0;
    for (size_t i = 0; i < s->n; i++)
        if (!s->sleeps[i])
            exchange(s, s->awake++, i);
}
