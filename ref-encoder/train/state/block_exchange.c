/* block_exchange.c - see block_exchange.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "block_exchange.h"

#include <string.h>

#include "view_exchange.h"

int ted4_blocks_shared(const ted4_trainer *t)
{
    return t->exchange != NULL && t->exchange->n > 1;
}

/* Returns the first chunk of a rank, of n. */
static size_t first_chunk(size_t rank, size_t n)
{
    return TED4_GEN_CHUNKS * rank / n;
}

void ted4_block_parts(const ted4_trainer *t, size_t floats, size_t *first)
{
    const size_t n = t->exchange->n;

    for (size_t r = 0; r <= n; r++)
        first[r] = floats * ted4_generate_first(t->visible_blocks.awake, first_chunk(r, n));
}

/* Packs the arrays [size] of this rank's chunks for the ranks that sum a part of each: part by
 * part, chunks chunks each, of which the last may be of no use. */
static void pack_chunks(const ted4_exchange *x, const float *gradients, size_t size, size_t chunks,
                        float *to)
{
    const size_t from = first_chunk(x->rank, x->n), n = first_chunk(x->rank + 1, x->n) - from;

    for (size_t r = 0; r < x->n; r++) {
        const size_t at = size * r / x->n, own = size * (r + 1) / x->n - at;

        memset(to + chunks * at, 0, chunks * own * sizeof *to);
        for (size_t c = 0; c < n; c++)
            memcpy(to + chunks * at + c * own, gradients + (from + c) * size + at,
                   own * sizeof *to);
    }
}

/* Adds part[own] of all chunks, in their order: received[ranks][chunks][own]. */
static void add_chunks(const ted4_exchange *x, const float *received, size_t own, size_t chunks,
                       float *part)
{
    for (size_t r = 0, done = 0; r < x->n; r++)
        for (size_t c = 0; done < first_chunk(r + 1, x->n); c++, done++) {
            const float *from = received + (r * chunks + c) * own;

            for (size_t i = 0; i < own; i++)
                part[i] = done == 0 ? from[i] : part[i] + from[i];
        }
}

/* Replaces the array of chunk 0 by the sum over the chunks of all ranks. */
static int sum_chunks(ted4_trainer *t)
{
    ted4_exchange *x = t->exchange;
    const size_t chunks = (TED4_GEN_CHUNKS + x->n - 1) / x->n;
    size_t size, first[TED4_MAX_RANKS + 1];
    float *gradients = ted4_generate_chunk_gradients(t->work.generator, &size);

    for (size_t r = 0; r <= x->n; r++)
        first[r] = chunks * (size * r / x->n);

    const size_t own = (first[x->rank + 1] - first[x->rank]) / chunks;
    float *packed = ted4_view_exchange_memory(&t->work.view_sums, chunks * (size + x->n * own));

    if (packed == NULL)
        return ted4_trainer_fail(t, "no memory for gradients of networks");
    pack_chunks(x, gradients, size, chunks, packed);
    ted4_exchange_deal(x, packed, first, x->n, packed + chunks * size);
    for (size_t r = 0; r <= x->n; r++)
        first[r] = size * r / x->n;
    add_chunks(x, packed + chunks * size, own, chunks, gradients + first[x->rank]);
    ted4_exchange_share(x, gradients, first);
    return 0;
}

int ted4_block_backward(ted4_trainer *t, const ted4_generate_input *in, const ted4_splat_grads *gr)
{
    ted4_exchange *x = t->exchange;
    size_t first[TED4_MAX_RANKS + 1];

    ted4_generate_backward_chunks(t->work.generator, in, gr, t->parallel,
                                  t->visible_blocks.gradient, first_chunk(x->rank, x->n),
                                  first_chunk(x->rank + 1, x->n));
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
