/* block_exchange.c - see block_exchange.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "block_exchange.h"

#include "chunk_exchange.h"

int ted4_blocks_shared(const ted4_trainer *t)
{
    return t->exchange != NULL && t->exchange->n > 1;
}

void ted4_block_parts(const ted4_trainer *t, size_t floats, size_t *first)
{
    const size_t n = t->exchange->n;

    for (size_t r = 0; r <= n; r++)
        first[r] = floats * ted4_generate_first(t->visible_blocks.awake,
                                                ted4_chunk_first(t->exchange, r, TED4_GEN_CHUNKS));
}

/* Replaces the array of chunk 0 by the sum over the chunks of all ranks. */
static int sum_chunks(ted4_trainer *t)
{
    size_t size;
    float *gradients = ted4_generate_chunk_gradients(t->work.generator, &size);
    const float *chunk[TED4_GEN_CHUNKS];

    for (size_t c = 0; c < TED4_GEN_CHUNKS; c++)
        chunk[c] = gradients + c * size;
    return ted4_chunk_exchange(t->exchange, &t->work.view_sums, chunk, TED4_GEN_CHUNKS, size, 0,
                               gradients) != 0
               ? ted4_trainer_fail(t, "no memory for gradients of networks")
               : 0;
}

int ted4_block_backward(ted4_trainer *t, const ted4_generate_input *in, const ted4_splat_grads *gr)
{
    ted4_exchange *x = t->exchange;
    size_t first[TED4_MAX_RANKS + 1];

    ted4_generate_backward_chunks(t->work.generator, in, gr, t->parallel,
                                  t->visible_blocks.gradient,
                                  ted4_chunk_first(x, x->rank, TED4_GEN_CHUNKS),
                                  ted4_chunk_first(x, x->rank + 1, TED4_GEN_CHUNKS));
    if (sum_chunks(t) != 0)
        return -1;
    ted4_block_parts(t, (size_t)t->layout.n_channels * TED4_LANES, first);
    ted4_exchange_share(x, t->visible_blocks.gradients, first);
    ted4_generate_backward_end(t->work.generator, in, t->net.gradient);
    return 0;
}

void ted4_block_share_centres(const ted4_trainer *t)
{
    size_t first[TED4_MAX_RANKS + 1];

    ted4_block_parts(t, (size_t)t->layout.head.n_offsets * TED4_LANES, first);
    for (int c = 0; c < 3; c++)
        ted4_exchange_share(t->exchange, t->work.splat_gradient.mean[c], first);
}
