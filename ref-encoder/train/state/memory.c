/* memory.c - the memory of a trainer: see trainer.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <stdlib.h>
#include <string.h>

#include "trainer.h"
#include "visible_blocks.h"

int ted4_trainer_rebuild(ted4_trainer *t)
{
    const size_t n = t->layout.n_net + 1;

    free(t->net);
    free(t->net_m);
    free(t->net_v);
    free(t->net_gradient);
    t->net = calloc(n, sizeof *t->net);
    t->net_m = calloc(n, sizeof *t->net_m);
    t->net_v = calloc(n, sizeof *t->net_v);
    t->net_gradient = calloc(n, sizeof *t->net_gradient);
    ted4_generator_free(t->generator);
    t->generator = ted4_generator_new(&t->layout);
    ted4_rate_free(t->rate);
    t->rate = ted4_rate_new(&t->layout);
    ted4_slots_finish(&t->slots);
    if (t->net == NULL || t->net_m == NULL || t->net_v == NULL || t->net_gradient == NULL ||
        t->generator == NULL || t->rate == NULL)
        return ted4_trainer_fail(t, "no memory for the networks");
    return 0;
}

void ted4_trainer_finish(ted4_trainer *t)
{
    ted4_anchors_finish(&t->anchors);
    ted4_slots_finish(&t->slots);
    free(t->net);
    free(t->net_m);
    free(t->net_v);
    free(t->net_gradient);
    free(t->shift);
    free(t->trial);
    free(t->order.item);
    ted4_generator_free(t->generator);
    ted4_rate_free(t->rate);
    ted4_raster_free(t->raster);
    ted4_loss_workspace_free(t->loss);
    ted4_colour_finish(&t->colour);
    ted4_snapshot_free(&t->watch.good);
    free(t->image);
    free(t->d_image);
    free(t->splat_storage);
    free(t->splat_visible);
    memset(t, 0, sizeof *t);
}
