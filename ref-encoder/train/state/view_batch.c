/* view_batch.c - see view_batch.h. A batch of one view needs no sums: its colours are generated
 * together with everything else.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "view_batch.h"

#include <string.h>

#include "block_exchange.h"
#include "picture.h"
#include "view_exchange.h"
#include "visible_blocks.h"

/* Arrays of ted4_splat_grads that the views share: mean, scale, rotation, opacity. */
enum { SHARED = 11 };

static void shared_arrays(const ted4_splat_grads *g, float *array[SHARED])
{
    memcpy(array, g->mean, sizeof g->mean);
    memcpy(array + 3, g->scale, sizeof g->scale);
    memcpy(array + 6, g->rot, sizeof g->rot);
    array[10] = g->opacity;
}

/* Returns the floats of a view before those of the caller: the shared arrays, block by block so
 * that processes can share the blocks, and what lies behind colours. */
static size_t gradients_of(const ted4_trainer *t, const ted4_view_batch *b)
{
    return SHARED * b->s.n + ted4_generate_view_size(t->work.generator, t->visible_blocks.awake);
}

int ted4_batch_begin(ted4_trainer *t, ted4_view_batch *b, const uint32_t *item, size_t n,
                     size_t per_block)
{
    memset(b, 0, sizeof *b);
    b->n = n;
    b->item = item;
    b->per_block = per_block;
    ted4_exchange_views(t->exchange, n, &b->first, &b->end);
    b->all.by_view = n > 1;
    for (size_t i = 0; i < n; i++)
        ted4_trainer_view(t, &t->data->pictures[item[i]], &b->v[i], b->camera[i]);
    memcpy(b->all.camera, b->camera[0], sizeof b->all.camera);
    if (ted4_visible_blocks_of(t, b->v, n) != 0 ||
        ted4_trainer_generate(t, &t->data->pictures[item[0]], TED4_PASS_STEP, &b->all, &b->s) != 0)
        return -1;
    b->in = b->all;
    b->opacity = b->s.opacity;
    if (n > 1 && ted4_view_sums_begin(&t->work.view_sums,
                                      gradients_of(t, b) + per_block * t->visible_blocks.n,
                                      b->end > b->first ? b->end - b->first : 1) != 0)
        return ted4_trainer_fail(t, "no memory for sums over views");
    return n > 1 ? ted4_trainer_reserve_splats(t, b->s.n) : 0;
}

typedef struct {
    const ted4_trainer *t;
    const ted4_view *v;
} seen_job;

static void look_at_block(void *arg, size_t i)
{
    const seen_job *j = arg;
    const ted4_visible_blocks *s = &j->t->visible_blocks;

    s->seen[i] = s->lanes[i] & ted4_block_visible(j->t, s->block[i], j->v);
}

int ted4_batch_render(ted4_trainer *t, ted4_view_batch *b, size_t i)
{
    if (b->n > 1) {
        seen_job j = { t, &b->v[i] };

        ted4_parallel_for(t->parallel, t->visible_blocks.n, look_at_block, &j);
        b->in.lanes = t->visible_blocks.seen;
        memcpy(b->in.camera, b->camera[i], sizeof b->in.camera);
        ted4_generate_view(t->work.generator, &b->in, t->parallel, &b->s);
    }
    return ted4_raster_forward(t->work.raster, &b->s, &b->v[i], t->parallel, 1, t->work.image) != 0
               ? ted4_trainer_fail(t, "no memory to render")
               : 0;
}

int ted4_batch_render_backward(ted4_trainer *t, ted4_view_batch *b, size_t i)
{
    return ted4_trainer_render_backward(t, &b->v[i], &b->s);
}

float *ted4_batch_other(ted4_trainer *t, const ted4_view_batch *b)
{
    return ted4_view_sums_next(&t->work.view_sums) + gradients_of(t, b);
}

/* A copy between the shared arrays and a place block by block. */
typedef struct {
    float *array[SHARED];
    float *sums;
    size_t row;   /* floats of one array in a block */
    size_t first; /* block of job 0 */
    float scale;  /* 0: to sums; otherwise from sums, times scale */
} copy_job;

static void copy_block(void *arg, size_t i)
{
    const copy_job *j = arg;
    const size_t block = j->first + i;

    for (size_t k = 0; k < SHARED; k++) {
        float *array = j->array[k] + block * j->row;
        float *sums = j->sums + (block * SHARED + k) * j->row;

        if (j->scale == 0)
            memcpy(sums, array, j->row * sizeof *sums);
        for (size_t at = 0; j->scale != 0 && at < j->row; at++)
            array[at] = sums[at] * j->scale;
    }
}

static copy_job make_copy(const ted4_trainer *t, float *sums, size_t first, float scale)
{
    copy_job j = { .sums = sums,
                   .row = (size_t)t->layout.head.n_offsets * TED4_LANES,
                   .first = first,
                   .scale = scale };

    shared_arrays(&t->work.splat_gradient, j.array);
    return j;
}

void ted4_batch_add(ted4_trainer *t, ted4_view_batch *b)
{
    if (b->n == 1)
        return;

    float *to = ted4_view_sums_next(&t->work.view_sums);
    copy_job j = make_copy(t, to, 0, 0);

    ted4_parallel_for(t->parallel, t->visible_blocks.awake, copy_block, &j);
    ted4_generate_view_backward(t->work.generator, &b->in, &t->work.splat_gradient, t->parallel,
                                to + SHARED * b->s.n);
    ted4_view_sums_add(&t->work.view_sums, t->parallel);
}

/* Computes the mean over the views, with several processes for this one's blocks alone. Returns 0,
 * or -1 with t->message filled. */
static int average_views(ted4_trainer *t, ted4_view_batch *b)
{
    ted4_view_sums *s = &t->work.view_sums;
    float *mean = ted4_view_sums_total(s, t->parallel);
    const size_t shared = SHARED * b->s.n, awake = t->visible_blocks.awake;
    const size_t row = ted4_generate_view_row(t->work.generator), rows = row * awake;
    const float share = 1.0f / (float)b->n;
    size_t from = 0, to = awake;

    if (ted4_blocks_shared(t)) {
        ted4_exchange *x = t->exchange;
        size_t splats[TED4_MAX_RANKS + 1], features[TED4_MAX_RANKS + 1];

        ted4_block_parts(t, SHARED * (size_t)t->layout.head.n_offsets * TED4_LANES, splats);
        ted4_block_parts(t, row, features);
        from = features[x->rank] / row;
        to = features[x->rank + 1] / row;
        x->steps++;
        if (ted4_view_exchange_part(x, s, 0, splats, b->n, t->parallel) != 0 ||
            ted4_view_exchange_part(x, s, shared, features, b->n, t->parallel) != 0 ||
            ted4_view_exchange(x, s, shared + rows, b->n, t->parallel) != 0)
            return ted4_trainer_fail(t, "no memory for sums over views");
    }

    copy_job j = make_copy(t, mean, from, share);

    ted4_parallel_for(t->parallel, to - from, copy_block, &j);
    ted4_view_sums_scale(mean + shared + row * from, row * (to - from), share, t->parallel);
    ted4_view_sums_scale(mean + shared + rows, gradients_of(t, b) - shared - rows, share,
                         t->parallel);
    b->all.view_sum = mean + shared;
    b->other = mean + gradients_of(t, b);
    b->s.opacity = b->opacity;
    return 0;
}

/* The picture has no gradient for blocks that it does not draw. */
static void clear_sleeping(void *arg, size_t i)
{
    const ted4_trainer *t = arg;

    memset(t->visible_blocks.gradient[t->visible_blocks.awake + i], 0,
           (size_t)t->layout.n_channels * TED4_LANES * sizeof(float));
}

int ted4_batch_backward(ted4_trainer *t, ted4_view_batch *b)
{
    if (b->n > 1 && average_views(t, b) != 0)
        return -1;
    ted4_parallel_for(t->parallel, t->visible_blocks.n - t->visible_blocks.awake, clear_sleeping,
                      t);
    if (b->n > 1 && ted4_blocks_shared(t))
        return ted4_block_backward(t, &b->all, &t->work.splat_gradient);
    return ted4_generate_backward(t->work.generator, &b->all, &t->work.splat_gradient, t->parallel,
                                  t->visible_blocks.gradient, t->net.gradient) != 0
               ? ted4_trainer_fail(t, "no memory for gradients")
               : 0;
}
