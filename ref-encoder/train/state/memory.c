/* memory.c - allocates and frees the memory of a trainer: see trainer.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <stdlib.h>
#include <string.h>

#include "trainer.h"
#include "visible_blocks.h"

int ted4_trainer_rebuild(ted4_trainer *t)
{
    const size_t n = t->layout.n_net + 1;

    free(t->net.value);
    free(t->net.m);
    free(t->net.v);
    free(t->net.gradient);
    t->net.value = calloc(n, sizeof *t->net.value);
    t->net.m = calloc(n, sizeof *t->net.m);
    t->net.v = calloc(n, sizeof *t->net.v);
    t->net.gradient = calloc(n, sizeof *t->net.gradient);
    ted4_generator_free(t->work.generator);
    t->work.generator = ted4_generator_new(&t->layout);
    ted4_rate_free(t->work.rate);
    t->work.rate = ted4_rate_new(&t->layout);
    ted4_visible_blocks_finish(&t->visible_blocks);
    if (t->net.value == NULL || t->net.m == NULL || t->net.v == NULL || t->net.gradient == NULL ||
        t->work.generator == NULL || t->work.rate == NULL)
        return ted4_trainer_fail(t, "no memory for the networks");
    return 0;
}

void ted4_trainer_finish(ted4_trainer *t)
{
    ted4_anchors_finish(&t->anchors);
    ted4_visible_blocks_finish(&t->visible_blocks);
    free(t->net.value);
    free(t->net.m);
    free(t->net.v);
    free(t->net.gradient);
    free(t->net.shift);
    free(t->search.trial);
    free(t->order.item);
    ted4_generator_free(t->work.generator);
    ted4_rate_free(t->work.rate);
    ted4_raster_free(t->work.raster);
    ted4_adjoint_free(t->work.adjoint);
    ted4_loss_workspace_free(t->work.loss);
    ted4_colour_finish(&t->colour);
    ted4_poses_finish(&t->poses);
    ted4_snapshot_free(&t->monitor.good);
    free(t->work.image);
    free(t->work.d_image);
    free(t->work.splat_storage);
    free(t->work.splat_visible);
    ted4_view_sums_finish(&t->work.view_sums);
    memset(t, 0, sizeof *t);
}
