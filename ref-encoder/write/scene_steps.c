/* scene_steps.c - ted4_scene_steps(): computes the step indices of every anchor from the hyperprior
 * (spec 10.1).
 * SPDX-License-Identifier: BSD-2-Clause */
#include "kernel/int_kernel.h"
#include "write/encode.h"

enum { STEP_BLOCKS = 64 };

/* Up to STEP_BLOCKS blocks of 64 anchors, which are processed in parallel. */
typedef struct {
    ted4_scene *s;
    const ted4_prior *prior;
    int32_t *out; /* [STEP_BLOCKS][P][64] */
    size_t first; /* the first anchor of block 0 */
} steps_batch;

static void steps_block(void *arg, size_t i)
{
    const steps_batch *b = arg;
    ted4_scene *s = b->s;
    const size_t a = b->first + i * TED4_PRIOR_BLOCK;
    const size_t left = s->head.n_anchors - a;
    const size_t n = left < TED4_PRIOR_BLOCK ? left : TED4_PRIOR_BLOCK;
    int32_t *out = b->out + i * s->shape.n_outputs * TED4_PRIOR_BLOCK;
    const int32_t *v = out + (size_t)s->shape.first_step_output * TED4_PRIOR_BLOCK;

    ted4_prior_hyper(b->prior, s->position + 3 * a, n, out);
    for (int t = 0; t < TED4_TYPES; t++) {
        if (s->shape.dim[t] == 0)
            continue;
        for (size_t j = 0; j < n; j++)
            s->step_index[t][a + j] = ted4_step_index(v[j]);
        v += TED4_PRIOR_BLOCK;
    }
}

ted4_status ted4_scene_steps(ted4_scene *s, const ted4_parallel *p, ted4_error *e)
{
    const size_t n_blocks = (s->head.n_anchors + (size_t)TED4_PRIOR_BLOCK - 1) / TED4_PRIOR_BLOCK;
    ted4_error own = { TED4_OK, 0 };
    ted4_arena arena;
    ted4_prior prior;
    steps_batch b = { .s = s, .prior = &prior };

    ted4_arena_init(&arena, NULL);
    ted4_fail(&own, ted4_prior_init(&prior, &s->head, &s->shape, &arena), 0);
    prior.dense = ted4_select_int_dense();
    b.out = ted4_arena_alloc(&arena, STEP_BLOCKS * (size_t)s->shape.n_outputs,
                             TED4_PRIOR_BLOCK * sizeof *b.out);
    if (b.out == NULL)
        ted4_fail(&own, TED4_E_LIMIT_MEMORY, 0);
    if (own.code == TED4_OK)
        (void)ted4_prior_load(&prior, s->nete.values, s->shift, &own);
    for (size_t i = 0; own.code == TED4_OK && i < n_blocks; i += STEP_BLOCKS) {
        b.first = i * TED4_PRIOR_BLOCK;
        ted4_parallel_for(p, n_blocks - i < STEP_BLOCKS ? n_blocks - i : STEP_BLOCKS, steps_block,
                          &b);
    }
    ted4_arena_finish(&arena);
    if (e != NULL)
        *e = own;
    return own.code;
}
