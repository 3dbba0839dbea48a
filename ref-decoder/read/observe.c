/* observe.c - a coder that codes nothing, and what is needed to walk tiles with it.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "read/observe.h"

#include <string.h>
#include "kernel/int_kernel.h"

static uint32_t number(ted4_coder *c, unsigned width, uint32_t value)
{
    (void)c;
    (void)width;
    return value;
}

static void sizes(ted4_coder *c, uint32_t *size, unsigned n)
{
    (void)c;
    memset(size, 0, n * sizeof *size);
}

static void open_substream(ted4_coder *c, size_t n)
{
    (void)c;
    (void)n;
}

static void close_substream(ted4_coder *c)
{
    (void)c;
}

const ted4_coder_ops ted4_observe_ops = {
    .number = number, .sizes = sizes, .open = open_substream, .close = close_substream
};

ted4_status ted4_observe_init(ted4_observation *l, const ted4_scene *given, const ted4_options *o)
{
    ted4_status verdict;

    l->scene = *given;
    ted4_arena_init(&l->arena, o);
    verdict = ted4_prior_init(&l->prior, &l->scene.head, &l->scene.shape, &l->arena);
    l->work = ted4_arena_alloc(&l->arena, 1, ted4_tile_work_size(&l->scene));
    if (l->work == NULL)
        verdict = TED4_E_LIMIT_MEMORY;
    if (verdict == TED4_OK) {
        l->prior.dense = ted4_select_int_dense();
        verdict = ted4_prior_load(&l->prior, l->scene.nete.values, l->scene.shift, NULL);
    }
    return verdict;
}

void ted4_observe_finish(ted4_observation *l)
{
    ted4_arena_finish(&l->arena);
}
