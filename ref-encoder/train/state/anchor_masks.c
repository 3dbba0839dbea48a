/* anchor_masks.c - evaluates the masks of anchors: see anchor_masks.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "anchor_masks.h"

uint16_t ted4_offset_bits(const ted4_trainer *t, size_t i)
{
    const ted4_layout *l = &t->layout;
    unsigned bits = 0;

    for (int k = 0; k < l->head.n_offsets; k++)
        if (!l->head.offset_mask ||
            ted4_mask_on(*ted4_anchor_value(&t->anchors, TED4_ROW_VALUE, i, l->offset_logit + k)))
            bits |= 1u << k;
    return (uint16_t)bits;
}

int ted4_is_dynamic(const ted4_trainer *t, size_t i)
{
    const ted4_header *h = &t->layout.head;

    return h->motion != TED4_MOTION_NONE &&
           (!h->temporal_mask || ted4_mask_on(*ted4_anchor_value(&t->anchors, TED4_ROW_VALUE, i,
                                                                 t->layout.temporal_logit)));
}

size_t ted4_count_dynamic(const ted4_trainer *t)
{
    size_t n = 0;

    for (size_t i = 0; i < t->anchors.n; i++)
        n += ted4_is_dynamic(t, i) != 0;
    return n;
}
