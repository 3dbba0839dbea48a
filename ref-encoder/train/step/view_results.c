/* view_results.c - see view_results.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "view_results.h"

#include <string.h>

/* What processes of one training have in common in each step. What they exchange after this depends
 * on it: arrays of other sizes must not meet. */
typedef struct {
    uint64_t iteration, anchors, pictures;
    uint64_t key, views, visible, awake; /* of the order of pictures; of this step */
    double loss;                         /* of the last step */
} common;

/* What a process tells of its views. */
typedef struct {
    common now;
    ted4_view_result result[TED4_MAX_VIEWS];
} letter;

static common common_of(const ted4_trainer *t, size_t n)
{
    common c;

    memset(&c, 0, sizeof c);
    c.iteration = t->iteration;
    c.anchors = t->anchors.n;
    c.pictures = t->data->n_pictures;
    c.key = t->order.key;
    c.views = n;
    c.visible = t->visible_blocks.n;
    c.awake = t->visible_blocks.awake;
    c.loss = t->progress.last_loss;
    return c;
}

int ted4_view_results_gather(ted4_trainer *t, ted4_view_result *r, size_t n)
{
    const ted4_exchange *x = t->exchange;
    const common mine = common_of(t, n);
    letter out = { .now = mine }, in[TED4_MAX_RANKS];
    size_t first, end;

    if (x == NULL)
        return 0;
    ted4_exchange_views(x, n, &first, &end);
    memcpy(out.result, r + first, (end - first) * sizeof *r);
    ted4_exchange_gather(t->exchange, &out, sizeof out, in);
    for (size_t rank = 0; rank < x->n; rank++) {
        ted4_exchange place = { .rank = rank, .n = x->n };

        if (memcmp(&in[rank].now, &mine, sizeof mine) != 0)
            return ted4_trainer_fail(t,
                                     "rank %zu is not at the same point of the same training as "
                                     "this one: do all have the same files and programs?",
                                     rank);
        ted4_exchange_views(&place, n, &first, &end);
        memcpy(r + first, in[rank].result, (end - first) * sizeof *r);
    }
    return 0;
}
