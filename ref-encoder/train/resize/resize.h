/* resize.h - changes the header of a trainer in stage 2, preserving as much of what its networks
 * compute as fits. Depends on trainer.h and prune_units.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_RESIZE_H
#define TED4_RESIZE_H

#include "train/math/prune_units.h"
#include "train/state/trainer.h"

/* What to reduce; a NULL pruning leaves the site as it is. If head asks for fewer units at a site
 * than before, the pruning here says which ones remain. The header may also: drop motion and
 * activation; change n_slices and slices, together with the features or as ted4_slices_merge left
 * them; change view, together with input; and change bank_rows and scale_domain. */
typedef struct {
    ted4_header head;
    int offset[TED4_MAX_OFFSETS]; /* [head.n_offsets] old index of each offset */
    const ted4_pruned_units *feature, *phi, *bank, *position;
    const ted4_pruned_units *input[TED4_NETS_R]; /* of the heads: feature and view direction */
    const ted4_pruned_units *hidden[TED4_NETS_R][TED4_MAX_LAYERS],
        *hyper[TED4_MAX_LAYERS]; /* by layer, from 1 to the number of hidden layers */
    const ted4_pruned_units *slice[TED4_MAX_SLICES];
} ted4_resize;

/* Initialises s to the trainer's header with all offsets: no change. */
void ted4_resize_begin(ted4_resize *s, const ted4_trainer *t);
/* Applies the change to networks, anchors and Adam's moments. May be called only between stage 1
 * and the integer stage. Returns 0, or -1 with t->message filled. */
int ted4_resize_apply(ted4_trainer *t, const ted4_resize *s);

#endif
