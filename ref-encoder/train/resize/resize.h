/* resize.h - a trainer in stage 2 becomes one of another header, with as much of what its networks
 * compute as there is room for. Depends on trainer.h and prune_units.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_RESIZE_H
#define TED4_RESIZE_H

#include "train/math/prune_units.h"
#include "train/state/trainer.h"

/* What becomes fewer. NULL: as it was. A header that asks for fewer units than before has the
 * pruning here that says which; what else it may change: motion and activation may go, n_slices and
 * slices with features or as ted4_slices_merge left them, view with input, bank_rows, scale_domain.
 */
typedef struct {
    ted4_header head;
    int offset[TED4_MAX_OFFSETS]; /* [head.n_offsets] old offset of each */
    const ted4_pruned_units *feature, *phi, *bank, *position;
    const ted4_pruned_units *input[TED4_NETS_R]; /* of heads, feature and view direction */
    const ted4_pruned_units *hidden[TED4_NETS_R][TED4_MAX_LAYERS],
        *hyper[TED4_MAX_LAYERS]; /* by layer, 1 .. hidden layers */
    const ted4_pruned_units *slice[TED4_MAX_SLICES];
} ted4_resize;

/* Changes nothing yet: the trainer's header, all offsets. */
void ted4_resize_begin(ted4_resize *s, const ted4_trainer *t);
/* Networks, anchors and moments of Adam go along; between integer stage and stage 1 only. 0, or -1
 * with t->message. */
int ted4_resize_apply(ted4_trainer *t, const ted4_resize *s);

#endif
