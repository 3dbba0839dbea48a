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
    size_t first, end;               /* the views that this process draws (exchange.h) */
    size_t per_block;                /* as given to ted4_batch_begin */
    const float *opacity;            /* borrowed: opacities of what at least one view sees */
    const float *other;              /* after ted4_batch_backward: sums of ted4_batch_other */
} ted4_view_batch;

/* All functions return 0, or -1 with t->message filled. */

/* Sets t->visible_blocks to the blocks that the pictures item[n] see, and generates what the views
 * share, for a training step (picture.h). per_block: floats that the caller wants summed over the
 * views for each visible block. */
int ted4_batch_begin(ted4_trainer *t, ted4_view_batch *b, const uint32_t *item, size_t n,
                     size_t per_block);
/* Renders view i into t->work.image. The views b->first to b->end come in order. */
int ted4_batch_render(ted4_trainer *t, ted4_view_batch *b, size_t i);
/* Backpropagates t->work.d_image of view i to t->work.splat_gradient. */
int ted4_batch_render_backward(ted4_trainer *t, ted4_view_batch *b, size_t i);
/* Of several views, returns the place [t->visible_blocks.n][per_block] for the caller's floats of
 * the latest view, to be filled before ted4_batch_add. */
float *ted4_batch_other(ted4_trainer *t, const ted4_view_batch *b);
/* Adds t->work.splat_gradient of the latest view to the sums. */
void ted4_batch_add(ted4_trainer *t, ted4_view_batch *b);
/* After the last view: exchanges sums with the other processes, and backpropagates the mean over
 * all views, which t->work.splat_gradient receives except for colours, to
 * t->visible_blocks.gradient; adds the gradients of networks to t->net.gradient. Of several views,
 * b->s then has the opacities of what at least one of them sees. */
int ted4_batch_backward(ted4_trainer *t, ted4_view_batch *b);

#endif
