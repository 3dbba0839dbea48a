/* layout.c - where each parameter of the trainable model lies (model.h).
 * SPDX-License-Identifier: BSD-2-Clause */
#include "model.h"

#include <string.h>

void ted4_layout_make(ted4_layout *l, const ted4_header *h)
{
    int channel = 0;

    memset(l, 0, sizeof *l);
    l->head = *h;
    ted4_shape_make(&l->shape, h);
    for (int t = 0; t < TED4_TYPES; t++) {
        l->first[t] = l->shape.dim[t] > 0 ? channel : -1;
        channel += (int)l->shape.dim[t];
    }
    l->offset_logit = channel;
    l->temporal_logit = channel + h->n_offsets;
    l->n_channels = l->temporal_logit + 1;
    l->netr = 0;
    l->bank = l->netr + l->shape.n_netr;
    l->nete = l->bank + (size_t)l->shape.n_bank;
    l->n_net = l->nete + l->shape.n_nete;
}
