/* count.c - ted4_count(): the ideal code length of the tiles of a scene.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <string.h>
#include "write/coder_count.h"
#include "write/encode.h"
#include "write/tiles.h"

/* Adds the bits of a tile. Its substreams come in the order of spec 9.1. */
static void add_tile(ted4_bits *bits, const ted4_counter *n, const ted4_scene *s)
{
    unsigned at = 0;

    bits->frame += n->frame;
    if (s->head.temporal_mask || s->head.offset_mask)
        bits->mask += n->substream[at++];
    for (unsigned m = 0; m < s->head.n_slices; m++) {
        bits->slice[m] += n->substream[at];
        bits->type[TED4_FEATURE] += n->substream[at++];
    }
    for (int t = TED4_SCALING; t < TED4_TYPES; t++)
        if (s->shape.dim[t] > 0)
            bits->type[t] += n->substream[at++];
}

ted4_status ted4_count(const ted4_scene *s, const ted4_parallel *p, ted4_bits *bits, ted4_error *e)
{
    ted4_error own = { TED4_OK, 0 };
    ted4_draft d;
    ted4_counter *counters = NULL;

    memset(bits, 0, sizeof *bits);
    ted4_fail(&own, ted4_draft_init(&d, s), 0);
    if (own.code == TED4_OK)
        (void)ted4_prior_load(&d.prior, s->nete.values, s->shift, &own);
    if (own.code == TED4_OK) {
        counters = ted4_arena_alloc(&d.arena, s->shape.n_tiles, sizeof *counters);
        if (counters == NULL)
            ted4_fail(&own, TED4_E_LIMIT_MEMORY, 0);
    }
    if (own.code == TED4_OK) {
        for (unsigned i = 0; i < s->shape.n_tiles; i++)
            ted4_counter_init(&counters[i]);
        own = ted4_draft_tiles(&d, counters, sizeof *counters, p);
    }
    for (unsigned i = 0; own.code == TED4_OK && i < s->shape.n_tiles; i++)
        add_tile(bits, &counters[i], s);
    bits->total = bits->frame + bits->mask;
    for (int t = 0; t < TED4_TYPES; t++)
        bits->total += bits->type[t];
    ted4_draft_finish(&d);
    if (e != NULL)
        *e = own;
    return own.code;
}
