/* view_batch.h - several views of one time: they share the Gaussians, except for colours, and the
 * way back from them. Gradients are means over the views. Depends on trainer.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_VIEW_BATCH_H
#define TED4_VIEW_BATCH_H

#include "trainer.h"

typedef struct {
    size_t n;             /* 1 to TED4_MAX_VIEWS */
    const uint32_t *item; /* [n] borrowed: numbers of pictures of one time */
    ted4_view v[TED4_MAX_VIEWS];
    float camera[TED4_MAX_VIEWS][3]; /* normalised space */
    ted4_generate_input all;         /* of t->visible_blocks: what at least one view sees */
    ted4_generate_input in;          /* of the latest view: its camera and lanes */
    ted4_splats s;                   /* Gaussians of the latest view; valid until the next batch */
} ted4_view_batch;

/* All functions return 0, or -1 with t->message filled. */

/* Sets t->visible_blocks to the blocks that the pictures item[n] see, and generates what the views
 * share, for a training step (picture.h). */
int ted4_batch_begin(ted4_trainer *t, ted4_view_batch *b, const uint32_t *item, size_t n);
/* Renders view i into t->work.image. The views come in order, from 0. */
int ted4_batch_render(ted4_trainer *t, ted4_view_batch *b, size_t i);
/* Backpropagates t->work.d_image of view i to t->work.splat_gradient. */
int ted4_batch_render_backward(ted4_trainer *t, ted4_view_batch *b, size_t i);
/* Adds t->work.splat_gradient of the latest view to the sums. */
void ted4_batch_add(ted4_trainer *t, ted4_view_batch *b);
/* After the last view: backpropagates the mean over the views, which t->work.splat_gradient
 * receives except for colours, to t->visible_blocks.gradient, and adds the gradients of networks to
 * t->net.gradient. */
int ted4_batch_backward(ted4_trainer *t, ted4_view_batch *b);

#endif
