/* saturation.c - counts the values of anchors that are saturated (saturation.h).
 * SPDX-License-Identifier: BSD-2-Clause */
#include "saturation.h"

#include <math.h>

#include "train/model/formulas.h"

#define LARGEST_LOG2_SIZE 126.0f
#define BEYOND_SYMBOLS    32767.5f

/* Returns whether component c of a type is saturated. q: its step size, or 0 while there is
 * none. */
static int is_saturated(const ted4_header *h, int type, unsigned c, float x, float q)
{
    if (type == TED4_SCALING &&
        (h->scale_domain == TED4_SCALE_LOG2 ? fabsf(x) > LARGEST_LOG2_SIZE : x <= TED4_SHORT))
        return 1;
    if (type == TED4_TAU && c % 2 == 1 && x <= TED4_EDGE_MIN_LOG2)
        return 1;
    return q > 0 && fabsf(x) > BEYOND_SYMBOLS * q;
}

size_t ted4_saturated_values(const ted4_trainer *t)
{
    const ted4_layout *l = &t->layout;
    size_t n = 0;

    for (int y = 0; y < TED4_TYPES; y++)
        for (unsigned c = 0; c < l->shape.dim[y]; c++)
            for (size_t i = 0; i < t->anchors.n; i++)
                n += (size_t)is_saturated(&l->head, y, c,
                                          *ted4_anchor_value(&t->anchors, TED4_ROW_VALUE, i,
                                                             l->first[y] + (int)c),
                                          *ted4_anchor_value(&t->anchors, TED4_ROW_STEP, i, y));
    return n;
}
